// In the browser: a scene with levels of detail, drawn by three.js at each of them.

import * as THREE from "three";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { KTX2Loader } from "three/addons/loaders/KTX2Loader.js";

const FIELD = 45;
/** Lines of a picture, which is as wide: what is left and right of it is empty. */
const LINES = 1080;
/** Pixels whose channels all differ by less look the same. */
const SAME = 8;
/** Where animated scenes are looked at, in seconds. */
const MOMENT = 0.5;
const DIRECTIONS = [[1, 0.3, 0.2], [-1, 0.2, -0.3], [0.2, 1, 0.3], [0.3, -1, 0.2], [-0.2, 0.3, 1], [0.3, 0.2, -1]];

const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
renderer.setClearColor(0, 0);
renderer.setSize(LINES, LINES, false);
document.body.append(renderer.domElement);
const environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
const textures = new KTX2Loader().setTranscoderPath("/three/examples/jsm/libs/basis/").detectSupport(renderer);
const loader = new GLTFLoader().setKTX2Loader(textures).setMeshoptDecoder(MeshoptDecoder);
/** What is drawn once a face, whatever the material. */
const plain = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });

let gltf, scene, levelled;

/** Loads a scene; how many nodes of it have levels. */
window.load = async (uri) => {
    scene?.traverse((part) => part.geometry?.dispose());
    gltf = await loader.loadAsync(uri);
    scene = new THREE.Scene();
    scene.environment = environment;
    scene.add(gltf.scene);
    const { associations, json } = gltf.parser;
    levelled = [];
    gltf.scene.traverse((object) => {
        const { nodes: node } = associations.get(object) ?? {};
        const { ids } = json.nodes[node]?.extensions?.MSFT_lod ?? {};
        // The primitives of a mesh are below their node, and are associated with it as well.
        const isOfParent = associations.get(object.parent)?.nodes === node;
        if (ids && !isOfParent) levelled.push({ object, node, ids, stands: [] });
    });
    for (const one of levelled) {
        for (const id of one.ids) {
            const stand = await gltf.parser.getDependency("node", id);
            one.stands.push(stand);
            one.object.parent.add(stand);
        }
    }
    gltf.scene.traverse((part) => (part.frustumCulled = false));
    show(0);
    return levelled.length;
};

/** The object that is drawn for a node at a level, and the node that it is. */
const at = ({ object, stands }, level) => (level === 0 ? object : stands[Math.min(level, stands.length) - 1]);
const nodeAt = ({ node, ids }, level) => (level === 0 ? node : ids[Math.min(level, ids.length) - 1]);

/** Shows a level, 0 the full one. */
function show(level) {
    for (const one of levelled) {
        const shown = at(one, level);
        for (const object of [one.object, ...one.stands]) object.visible = object === shown;
    }
    scene.updateMatrixWorld(true);
}

/** The ball around what is drawn in full. */
function ball() {
    const box = new THREE.Box3();
    const position = new THREE.Vector3();
    gltf.scene.traverse((part) => {
        const stands = levelled.flatMap((one) => one.stands);
        if (!part.geometry || stands.some((stand) => isBelow(part, stand))) return;
        for (let vertex = 0; vertex < part.geometry.attributes.position.count; vertex++) {
            // Where skins and morph targets put it.
            const own = part.isMesh
                ? part.getVertexPosition(vertex, position)
                : position.fromBufferAttribute(part.geometry.attributes.position, vertex);
            box.expandByPoint(own.applyMatrix4(part.matrixWorld));
        }
    });
    return box.getBoundingSphere(new THREE.Sphere());
}

function isBelow(part, above) {
    for (let object = part; object; object = object.parent) if (object === above) return true;
    return false;
}

function cameraAt(direction, { center, radius }, distance) {
    const near = Math.max(distance - 1.01 * radius, distance / 1000);
    const camera = new THREE.PerspectiveCamera(FIELD, 1, near, distance + 1.01 * radius);
    camera.position.fromArray(direction).setLength(distance).add(center);
    camera.lookAt(center);
    return camera;
}

/** The distance from which a ball just fits. */
const fitting = ({ radius }) => radius / Math.sin(THREE.MathUtils.degToRad(FIELD / 2));

/** Draws what is shown once a face: how many triangles the renderer counts, how many pixels they cover. */
function drawn() {
    const around = ball();
    scene.overrideMaterial = plain;
    const pixels = picture(cameraAt(DIRECTIONS[0], around, fitting(around)));
    scene.overrideMaterial = null;
    let covered = 0;
    for (let at = 3; at < pixels.length; at += 4) covered += pixels[at] !== 0;
    return { triangles: renderer.info.render.triangles, covered };
}

function picture(camera) {
    renderer.render(scene, camera);
    const pixels = new Uint8Array(4 * LINES * LINES);
    const gl = renderer.getContext();
    gl.readPixels(0, 0, LINES, LINES, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return pixels;
}

/** What is drawn at a level, at rest. */
window.drawnAt = (level) => {
    show(level);
    return drawn();
};

/** The same for each animation, a while after its start, and what it does to the nodes at that level. */
window.movedAt = (level) => gltf.animations.map((clip) => {
    show(level);
    const rest = levelled.map((one) => stateOf(one, level));
    const mixer = new THREE.AnimationMixer(gltf.scene);
    mixer.clipAction(clip).play();
    mixer.setTime(Math.min(MOMENT, clip.duration));
    scene.updateMatrixWorld(true);
    const states = levelled.map((one) => [stateOf(one, 0), stateOf(one, level)]);
    const found = {
        ...drawn(),
        moved: states.filter(([, now], i) => now !== rest[i]).length,
        apart: levelled.filter((_, i) => states[i][0] !== states[i][1]).map(({ node }) => node),
    };
    mixer.stopAllAction();
    mixer.uncacheRoot(gltf.scene);
    return found;
});

/** The meshes of a node: the object itself, or those of several primitives below it. */
function partsOf(object, node) {
    const { meshes, nodes } = gltf.parser.json;
    const count = meshes[nodes[node].mesh].primitives.length;
    return count > 1 ? object.children.slice(0, count) : [object];
}

/** Where a node is, and what else moves its vertices: morph targets and bones. */
function stateOf(one, level) {
    const object = at(one, level);
    const parts = partsOf(object, nodeAt(one, level));
    const morphs = parts.map(({ morphTargetInfluences }) => morphTargetInfluences ?? []);
    const skins = parts.map((part) => [part.bindMatrix?.elements ?? [], part.skeleton?.bones.map(({ uuid }) => uuid) ?? []]);
    return JSON.stringify([object.matrixWorld.elements, morphs, skins]);
}

/** The longest that one unit of an object's positions is drawn. */
function scaleOf({ object, node }) {
    let scale = 0;
    for (const part of partsOf(object, node)) {
        const ways = part.isSkinnedMesh
            ? part.skeleton.bones.map((bone, i) => new THREE.Matrix4()
                .multiplyMatrices(bone.matrixWorld, part.skeleton.boneInverses[i]).multiply(part.bindMatrix))
            : [part.matrixWorld];
        scale = Math.max(scale, ...ways.map((way) => way.getMaxScaleOnAxis()));
    }
    return scale;
}

/**
 * Compares pictures of a level with those of the full scene, from all directions: `errors` has that of each mesh. The
 * camera is where a pixel is as long as the largest error in the scene, but not so near that the scene does not fit.
 */
window.compare = (level, errors) => {
    show(0);
    const around = ball();
    let error = 0;
    for (const one of levelled) {
        const { mesh } = gltf.parser.json.nodes[nodeAt(one, level)];
        error = Math.max(error, (errors[mesh] ?? 0) * scaleOf(one));
    }
    const pixel = 2 * Math.tan(THREE.MathUtils.degToRad(FIELD / 2)) / LINES;
    const wanted = error / pixel;
    const distance = Math.max(wanted, fitting(around));
    const views = DIRECTIONS.map((direction) => {
        const camera = cameraAt(direction, around, distance);
        show(0);
        const full = picture(camera);
        show(level);
        return different(full, picture(camera));
    });
    return { views, pixels: error / (pixel * distance), radius: around.radius / (pixel * distance) };
};

/** The pixels that either picture covers, and those that differ. */
function different(full, other) {
    let [covered, differing] = [0, 0];
    for (let at = 0; at < full.length; at += 4) {
        if (full[at + 3] === 0 && other[at + 3] === 0) continue;
        covered += 1;
        for (let part = at; part < at + 4; part++) {
            if (Math.abs(full[part] - other[part]) <= SAME) continue;
            differing += 1;
            break;
        }
    }
    return { covered, differing };
}
