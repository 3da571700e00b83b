// A GLB with everything that re-ordering could lose: skin, morph target, custom attribute, sparse
// and interleaved accessors, outlines, extras and a private extension on every kind of object.
//
// Written with plain buffers and JSON, so that no library's habits are in it. Always the same bytes.
//
// Usage: node made.mjs OUT.glb

import { writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { objects, PRIVATE } from "./objects.mjs";
import { seeded, shuffled } from "./random.mjs";

const FLOAT = 5126;
const UNSIGNED_BYTE = 5121;
const UNSIGNED_SHORT = 5123;
const UNSIGNED_INT = 5125;
const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
const SIZES = { [FLOAT]: 4, [UNSIGNED_BYTE]: 1, [UNSIGNED_SHORT]: 2, [UNSIGNED_INT]: 4 };
const ARRAY_BUFFER = 34962;
const ELEMENT_ARRAY_BUFFER = 34963;
/** Quads along a side of each mesh. */
const SIDE = 20;
/** A grey pixel as PNG. */
const PIXEL =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==";

/** A wavy grid, vertices and faces shuffled, with the edges of its border. */
function grid(seed, offset) {
    const random = seeded(seed);
    const row = SIDE + 1;
    const count = row * row;
    const places = shuffled(Array(count).keys(), random);
    const number = [];
    places.forEach((place, vertex) => (number[place] = vertex));
    const vertices = places.map((place) => {
        const [x, y] = [(place % row) / SIDE, Math.floor(place / row) / SIDE];
        const z = 0.1 * Math.sin(7 * x) * Math.cos(5 * y);
        const slope = [-0.7 * Math.cos(7 * x) * Math.cos(5 * y), 0.5 * Math.sin(7 * x) * Math.sin(5 * y), 1];
        const length = Math.hypot(...slope);
        return { x, y, position: [x + offset, y, z], normal: slope.map((s) => s / length) };
    });
    const faces = [];
    const border = [];
    for (let y = 0; y < SIDE; y++) {
        for (let x = 0; x < SIDE; x++) {
            const at = y * row + x;
            const [a, b, c, d] = [at, at + 1, at + row + 1, at + row].map((place) => number[place]);
            faces.push([a, b, c], [a, c, d]);
        }
        const at = y * row;
        border.push([number[at], number[at + row]], [number[at + SIDE], number[at + row + SIDE]]);
        border.push([number[y], number[y + 1]], [number[SIDE * row + y], number[SIDE * row + y + 1]]);
    }
    const turned = faces.map((face) => {
        const turn = Math.floor(random() * 3);
        return [...face.slice(turn), ...face.slice(0, turn)];
    });
    return { vertices, faces: shuffled(turned, random), border: shuffled(border, random) };
}

function encode(values, component) {
    const bytes = Buffer.alloc(values.length * SIZES[component]);
    values.forEach((value, i) => {
        const at = i * SIZES[component];
        if (component === FLOAT) bytes.writeFloatLE(value, at);
        else bytes.writeUIntLE(value, at, SIZES[component]);
    });
    return bytes;
}

class Builder {
    /** Buffer 0 is the binary chunk, 1 a data URI. */
    chunks = [[], []];
    lengths = [0, 0];
    accessors = [];
    bufferViews = [];

    view(bytes, { buffer = 0, ...more } = {}) {
        const padding = -this.lengths[buffer] & 3;
        this.chunks[buffer].push(Buffer.alloc(padding), bytes);
        const byteOffset = this.lengths[buffer] + padding;
        this.lengths[buffer] = byteOffset + bytes.length;
        this.bufferViews.push({ buffer, byteOffset, byteLength: bytes.length, ...more });
        return this.bufferViews.length - 1;
    }

    /** Adds an accessor over elements (arrays of numbers) in a view of its own, or in `view`. */
    accessor(elements, type, componentType, { target, view, buffer, bounds = false, ...more } = {}) {
        const bufferView =
            view ?? this.view(encode(elements.flat(), componentType), { buffer, ...(target && { target }) });
        const accessor = { bufferView, componentType, count: elements.length, type, ...more };
        if (bounds) {
            const columns = [...Array(COMPONENTS[type]).keys()];
            const column = (i) => elements.map((element) => Math.fround([element].flat()[i]));
            accessor.min = columns.map((i) => Math.min(...column(i)));
            accessor.max = columns.map((i) => Math.max(...column(i)));
        }
        this.accessors.push(accessor);
        return this.accessors.length - 1;
    }

    attribute(elements, type, componentType = FLOAT, more = {}) {
        return this.accessor(elements, type, componentType, { target: ARRAY_BUFFER, ...more });
    }

    positions(vertices) {
        return this.attribute(vertices.map((v) => v.position), "VEC3", FLOAT, { bounds: true });
    }

    indices(faces, componentType) {
        return this.accessor(faces.flat(), "SCALAR", componentType, { target: ELEMENT_ARRAY_BUFFER });
    }
}

/** The bytes of the file. */
export function make() {
    const build = new Builder();
    const normals = (vertices) => build.attribute(vertices.map((v) => v.normal), "VEC3");
    const coordinates = (vertices) => build.attribute(vertices.map((v) => [v.x, v.y]), "VEC2");

    // An unknown extension on the primitive: its faces can move, its vertices may be numbered by it.
    const a = grid(1, 0);
    const meshA = {
        name: "private",
        primitives: [
            {
                attributes: {
                    POSITION: build.positions(a.vertices),
                    NORMAL: normals(a.vertices),
                    TEXCOORD_0: coordinates(a.vertices),
                },
                indices: build.indices(a.faces, UNSIGNED_SHORT),
                material: 0,
                extensions: { [PRIVATE]: { seams: [3, 14, 15] } },
            },
        ],
        extensions: { [PRIVATE]: { kind: "mesh" } },
    };
    const privateAccessors = [0, 1];

    // Everything can move.
    const b = grid(2, 2);
    const bulge = (v) => [0, 0, 0.25 * Math.sin(3 * v.x) * Math.sin(3 * v.y)];
    // Never zero, which the Khronos validator would warn of for joint 1.
    const weights = (v) => [0.9 - 0.8 * v.x, 0.1 + 0.8 * v.x, 0, 0];
    const meshB = {
        name: "skinned",
        primitives: [
            {
                attributes: {
                    POSITION: build.positions(b.vertices),
                    NORMAL: normals(b.vertices),
                    TEXCOORD_0: coordinates(b.vertices),
                    JOINTS_0: build.attribute(b.vertices.map(() => [0, 1, 0, 0]), "VEC4", UNSIGNED_BYTE),
                    WEIGHTS_0: build.attribute(b.vertices.map(weights), "VEC4"),
                    _TEMPERATURE: build.attribute(b.vertices.map((v) => 20 + v.x + v.y * v.y), "SCALAR"),
                },
                targets: [
                    {
                        POSITION: build.attribute(b.vertices.map(bulge), "VEC3", FLOAT, { bounds: true }),
                        NORMAL: build.attribute(b.vertices.map((v) => [-v.y / 8, -v.x / 8, 0]), "VEC3"),
                    },
                ],
                indices: build.indices(b.faces, UNSIGNED_SHORT),
                material: 0,
                extensions: {
                    CESIUM_primitive_outline: {
                        indices: build.accessor(b.border.flat(), "SCALAR", UNSIGNED_SHORT, {
                            target: ELEMENT_ARRAY_BUFFER,
                        }),
                    },
                },
            },
        ],
        weights: [0.25],
    };

    // Texture coordinates of which a few are replaced.
    const c = grid(3, 4);
    const replaced = c.vertices.map((v, i) => (v.x < 0.2 ? i : -1)).filter((i) => i >= 0);
    const sparse = coordinates(c.vertices);
    build.accessors[sparse].sparse = {
        count: replaced.length,
        indices: { bufferView: build.view(encode(replaced, UNSIGNED_SHORT)), componentType: UNSIGNED_SHORT },
        values: { bufferView: build.view(encode(replaced.flatMap((i) => [c.vertices[i].y, 0.5]), FLOAT)) },
    };
    const meshC = {
        name: "sparse",
        primitives: [
            {
                attributes: { POSITION: build.positions(c.vertices), NORMAL: normals(c.vertices), TEXCOORD_0: sparse },
                indices: build.indices(c.faces, UNSIGNED_SHORT),
                material: 0,
            },
        ],
    };

    // Position, normal, coordinates, colour and temperature of a vertex side by side.
    const d = grid(4, 6);
    const colour = (v) => [Math.round(255 * v.x), Math.round(255 * v.y), 128, 255];
    const records = d.vertices.map((v) =>
        Buffer.concat([
            encode([...v.position, ...v.normal, v.x, v.y], FLOAT),
            encode(colour(v), UNSIGNED_BYTE),
            encode([20 + v.x * v.y], FLOAT),
        ]),
    );
    const view = build.view(Buffer.concat(records), { byteStride: 40, target: ARRAY_BUFFER });
    const interleaved = (elements, type, byteOffset, component = FLOAT, more = {}) =>
        build.accessor(elements, type, component, { view, byteOffset, ...more });
    const meshD = {
        name: "interleaved",
        primitives: [
            {
                attributes: {
                    POSITION: interleaved(d.vertices.map((v) => v.position), "VEC3", 0, FLOAT, { bounds: true }),
                    NORMAL: interleaved(d.vertices.map((v) => v.normal), "VEC3", 12),
                    TEXCOORD_0: interleaved(d.vertices.map((v) => [v.x, v.y]), "VEC2", 24),
                    COLOR_0: interleaved(d.vertices.map(colour), "VEC4", 32, UNSIGNED_BYTE, { normalized: true }),
                    _TEMPERATURE: interleaved(d.vertices.map((v) => 20 + v.x * v.y), "SCALAR", 36),
                },
                indices: build.indices(d.faces, UNSIGNED_INT),
                material: 0,
            },
        ],
    };

    const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    const moved = identity.with(12, -2.5);
    const inverseBindMatrices = build.accessor([identity, moved], "MAT4", FLOAT);
    // The animation lies in a buffer of its own: there a private extension keeps no vertex in place.
    const times = build.accessor([0, 1], "SCALAR", FLOAT, { buffer: 1, bounds: true });
    const morphWeights = build.accessor([0, 1], "SCALAR", FLOAT, { buffer: 1 });
    const turns = build.accessor([[0, 0, 0, 1], [0, 0, 0.5 ** 0.5, 0.5 ** 0.5]], "VEC4", FLOAT, { buffer: 1 });
    const colours = build.accessor([[1, 1, 1, 1], [1, 0, 0, 1]], "VEC4", FLOAT, { buffer: 1 });
    const image = build.view(Buffer.from(PIXEL, "base64"));

    const json = {
        asset: { version: "2.0", generator: "meshweft validate/made.mjs" },
        extensionsUsed: [PRIVATE, "CESIUM_primitive_outline", "KHR_animation_pointer"],
        scene: 0,
        scenes: [{ name: "scene", nodes: [0, 1, 2, 3, 4, 6] }],
        nodes: [
            { name: "private", mesh: 0 },
            { name: "skinned", mesh: 1, skin: 0 },
            { name: "sparse", mesh: 2 },
            { name: "interleaved", mesh: 3, translation: [0, 0.5, 0] },
            { name: "joint 0", translation: [2, 0, 0], children: [5] },
            { name: "joint 1", translation: [0.5, 0, 0] },
            { name: "camera", camera: 0, translation: [4, 0.5, 8] },
        ],
        meshes: [meshA, meshB, meshC, meshD],
        skins: [{ name: "skin", inverseBindMatrices, joints: [4, 5], skeleton: 4 }],
        animations: [
            {
                name: "animation",
                samplers: [
                    { input: times, output: morphWeights },
                    { input: times, output: turns },
                    { input: times, output: colours },
                ],
                channels: [
                    { sampler: 0, target: { node: 1, path: "weights" } },
                    { sampler: 1, target: { node: 5, path: "rotation" } },
                    {
                        sampler: 2,
                        target: {
                            path: "pointer",
                            extensions: {
                                KHR_animation_pointer: { pointer: "/materials/0/pbrMetallicRoughness/baseColorFactor" },
                            },
                        },
                    },
                ],
            },
        ],
        materials: [
            {
                name: "material",
                pbrMetallicRoughness: { baseColorTexture: { index: 0 }, baseColorFactor: [1, 1, 1, 1] },
                doubleSided: true,
            },
        ],
        textures: [{ name: "texture", source: 0, sampler: 0 }],
        images: [{ name: "image", bufferView: image, mimeType: "image/png" }],
        samplers: [{ name: "sampler", magFilter: 9729, minFilter: 9729 }],
        cameras: [
            { name: "camera", type: "perspective", perspective: { yfov: 0.8, znear: 0.1, zfar: 100, aspectRatio: 1.5 } },
        ],
        accessors: build.accessors,
        bufferViews: build.bufferViews,
        buffers: [],
    };
    const [chunk, beside] = build.chunks.map((parts) => Buffer.concat(parts));
    json.buffers.push(
        { byteLength: chunk.length },
        { byteLength: beside.length, uri: `data:application/octet-stream;base64,${beside.toString("base64")}` },
    );

    for (const { kind, object } of objects(json)) {
        object.extras = { note: `extras of ${kind}`, list: [1, 2.5, { deep: true }] };
    }
    const allowed = privateObjects(json, privateAccessors);
    for (const { kind, object } of allowed) {
        object.extensions = { ...object.extensions, [PRIVATE]: { kind, ...object.extensions?.[PRIVATE] } };
    }
    return glb(json, chunk);
}

/** The objects that carry the private extension: all but those that would keep vertices in place. */
function privateObjects(json, privateAccessors) {
    const beside = (view) => json.bufferViews[view].buffer === 1 || view === json.images[0].bufferView;
    const isAllowed = ({ kind, object }) => {
        switch (kind) {
            case "mesh":
            case "primitive":
                return object.extensions?.[PRIVATE] !== undefined;
            case "accessor":
                return privateAccessors.includes(json.accessors.indexOf(object)) || beside(object.bufferView);
            case "bufferView":
                return beside(json.bufferViews.indexOf(object));
            case "buffer":
                return object.uri !== undefined;
            default:
                return true;
        }
    };
    return [...objects(json)].filter(isAllowed);
}

function glb(json, binary) {
    const chunk = (bytes, type, filler) => {
        const padded = Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, filler)]);
        const head = Buffer.alloc(8);
        head.writeUInt32LE(padded.length, 0);
        head.write(type, 4, "latin1");
        return Buffer.concat([head, padded]);
    };
    const body = Buffer.concat([chunk(Buffer.from(JSON.stringify(json)), "JSON", " "), chunk(binary, "BIN\0", 0)]);
    const head = Buffer.alloc(12);
    head.write("glTF", 0, "latin1");
    head.writeUInt32LE(2, 4);
    head.writeUInt32LE(12 + body.length, 8);
    return Buffer.concat([head, body]);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    writeFileSync(process.argv[2], make());
}
