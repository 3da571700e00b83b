// The objects of a glTF file, kind by kind.

/** An extension that no tool knows. */
export const PRIVATE = "ACME_private";

/** Every object of a glTF that may carry extras and extensions, and its kind. */
export function* objects(json) {
    yield { kind: "root", object: json };
    yield { kind: "asset", object: json.asset };
    const kinds = {
        scenes: "scene",
        nodes: "node",
        meshes: "mesh",
        materials: "material",
        textures: "texture",
        images: "image",
        samplers: "sampler",
        skins: "skin",
        animations: "animation",
        cameras: "camera",
        accessors: "accessor",
        bufferViews: "bufferView",
        buffers: "buffer",
    };
    for (const [list, kind] of Object.entries(kinds)) {
        for (const object of json[list] ?? []) yield { kind, object };
    }
    for (const mesh of json.meshes ?? []) {
        for (const object of mesh.primitives) yield { kind: "primitive", object };
    }
    for (const animation of json.animations ?? []) {
        for (const object of animation.channels) {
            yield { kind: "animation channel", object };
            yield { kind: "animation target", object: object.target };
        }
        for (const object of animation.samplers) yield { kind: "animation sampler", object };
    }
    for (const material of json.materials ?? []) {
        const inner = material.pbrMetallicRoughness;
        if (!inner) continue;
        yield { kind: "pbrMetallicRoughness", object: inner };
        if (inner.baseColorTexture) yield { kind: "texture info", object: inner.baseColorTexture };
    }
    for (const camera of json.cameras ?? []) {
        if (camera.perspective) yield { kind: "perspective", object: camera.perspective };
    }
    for (const { sparse } of json.accessors ?? []) {
        if (!sparse) continue;
        yield { kind: "sparse", object: sparse };
        yield { kind: "sparse indices", object: sparse.indices };
        yield { kind: "sparse values", object: sparse.values };
    }
}
