// three.js' GLTFLoader without a browser, and what it loaded compared but for the order.

import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";

// The loader looks for browser functions in `self`.
globalThis.self = globalThis;
const { BufferAttribute, BufferGeometry, Texture } = await import("three");
const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
const { MeshoptDecoder } = await import("three/addons/libs/meshopt_decoder.module.js");
await MeshoptDecoder.ready;

/** A texture that is known by its number in the file. */
const named = (number) => Promise.resolve(Object.assign(new Texture(), { name: `texture ${number}` }));

/** Buffers from files, and no pictures: there is nothing to decode them here. */
function withoutBrowser(folder) {
    return (parser) => {
        parser.fileLoader = {
            load: (uri, done, _, failed) => bytesOf(folder, uri).then(done, failed),
        };
        return { name: "without_browser", loadTexture: named };
    };
}

async function bytesOf(folder, uri) {
    const bytes = uri.startsWith("data:")
        ? Buffer.from(uri.slice(uri.indexOf(",") + 1), "base64")
        : await readFile(join(folder, decodeURIComponent(uri)));
    return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

/** In place of the Draco decoder, which runs in a browser's workers: the bytes as they are. */
const undecoded = {
    preload: () => undecoded,
    decodeDracoFile(bytes, done) {
        const geometry = new BufferGeometry();
        geometry.userData.draco = Buffer.from(bytes).toString("latin1");
        done(geometry.setAttribute("position", new BufferAttribute(new Float32Array(9), 3)));
    },
};

/** What three.js makes of a file, or fails with. */
export async function loadScene(file) {
    const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).setDRACOLoader(undecoded);
    // Before the loader's own plug-ins, some of which refuse textures that they cannot decode.
    loader.pluginCallbacks.unshift(withoutBrowser(dirname(file)));
    const { warn, error: complain } = console;
    console.warn = console.error = () => {};
    try {
        const bytes = await readFile(file);
        const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
        return { gltf, primitives: await primitivesOf(gltf) };
    } finally {
        Object.assign(console, { warn, error: complain });
    }
}

/** All primitives in the file's order. */
async function primitivesOf({ parser }) {
    const meshes = await parser.getDependencies("mesh");
    return meshes.flatMap((mesh, number) => {
        // A group holds the primitives, then whatever is below the node that draws it.
        const count = parser.json.meshes[number].primitives.length;
        const parts = count > 1 ? mesh.children.slice(0, count) : [mesh];
        return parts.map(({ type, geometry, material }) => ({ kind: type, geometry, material }));
    });
}

/** The geometries of all primitives in the file's order and what else was loaded, or the error. */
export async function load(file) {
    try {
        const { gltf, primitives } = await loadScene(file);
        const skins = await gltf.parser.getDependencies("skin");
        const rest = JSON.stringify({
            animations: gltf.animations.map((clip) => clip.toJSON()),
            skins: skins.map((skin) => skin.boneInverses?.map((matrix) => matrix.elements)),
        });
        return { primitives, rest: withoutChance(rest) };
    } catch (error) {
        return { error: String(error.message ?? error), primitives: [], rest: "" };
    }
}

/** A material's parameters and the numbers of its textures. */
export function parameters(material) {
    return withoutChance(JSON.stringify(material.toJSON()));
}

/** Every new name that three.js gives to an unnamed node, in the order in which they come. */
function withoutChance(text) {
    const known = new Map();
    return text.replace(/[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}/gi, (uuid) => {
        if (!known.has(uuid)) known.set(uuid, known.size);
        return `uuid ${known.get(uuid)}`;
    });
}

/** The bytes of each vertex: all attributes and morph targets, one after the other. */
export function vertexRecords(geometry) {
    const morphs = Object.entries(geometry.morphAttributes);
    const sets = [
        ...Object.entries(geometry.attributes),
        ...morphs.flatMap(([name, list]) => list.map((attribute, i) => [`${name} ${i}`, attribute])),
    ].sort(([a], [b]) => (a < b ? -1 : 1));
    const count = geometry.attributes.position?.count ?? 0;
    const records = Array(count).fill("");
    for (const [, attribute] of sets) {
        const array = attribute.isInterleavedBufferAttribute ? attribute.data.array : attribute.array;
        const stride = attribute.isInterleavedBufferAttribute ? attribute.data.stride : attribute.itemSize;
        const offset = attribute.isInterleavedBufferAttribute ? attribute.offset : 0;
        const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString("latin1");
        const width = array.BYTES_PER_ELEMENT;
        for (let vertex = 0; vertex < count; vertex++) {
            const start = (vertex * stride + offset) * width;
            records[vertex] += bytes.slice(start, start + attribute.itemSize * width);
        }
    }
    const describe = ([name, { itemSize, normalized, count: n, gpuType }]) => [name, itemSize, normalized, n, gpuType];
    return { records, layout: JSON.stringify([sets.map(describe), geometry.morphTargetsRelative]) };
}

/**
 * The numbers of all corners' vertices; equal vertices have equal numbers in all geometries that
 * share `known`.
 */
function cornerNumbers(geometry, records, known) {
    const ofVertex = records.map((record) => {
        if (!known.has(record)) known.set(record, known.size);
        return known.get(record);
    });
    const index = geometry.index?.array ?? ofVertex.keys();
    return Array.from(index, (vertex) => ofVertex[vertex] ?? -1);
}

/** How often each triangle occurs: with its orientation, whichever corner it starts with. */
function triangles(corners) {
    const counts = new Map();
    for (let at = 0; at + 2 < corners.length; at += 3) {
        const [a, b, c] = [corners[at], corners[at + 1], corners[at + 2]];
        const turns = [[a, b, c], [b, c, a], [c, a, b]];
        const key = turns.reduce((least, turn) => (isLess(turn, least) ? turn : least)).join();
        counts.set(key, (counts.get(key) ?? 0) + 1);
    }
    return counts;
}

function isLess(a, b) {
    return a[0] - b[0] || a[1] - b[1] || a[2] - b[2] ? (a[0] - b[0] || a[1] - b[1] || a[2] - b[2]) < 0 : false;
}

/** What differs between two loaded files but the order of faces and vertices. */
export function differences(before, after) {
    const found = { problems: [], geometries: before.primitives.length, triangles: 0, draco: 0 };
    const differ = (what) => found.problems.push(what);
    if (before.error !== after.error) differ(`${before.error ?? "loaded"} | ${after.error ?? "loaded"}`);
    if (before.rest !== after.rest) differ("animations or skins");
    if (before.primitives.length !== after.primitives.length) differ("the number of primitives");
    before.primitives.forEach((old, number) => {
        const made = after.primitives[number];
        if (!made) return;
        if (old.kind !== made.kind) differ(`primitive ${number}: ${old.kind} | ${made.kind}`);
        if (old.geometry.userData.draco !== undefined) {
            found.draco += 1;
            if (old.geometry.userData.draco !== made.geometry.userData.draco) differ(`primitive ${number}: Draco bytes`);
            return;
        }
        const [oldVertices, madeVertices] = [vertexRecords(old.geometry), vertexRecords(made.geometry)];
        if (oldVertices.layout !== madeVertices.layout) differ(`primitive ${number}: attributes`);
        const known = new Map();
        const oldCorners = cornerNumbers(old.geometry, oldVertices.records, known);
        const madeCorners = cornerNumbers(made.geometry, madeVertices.records, known);
        if (oldCorners.length !== madeCorners.length) differ(`primitive ${number}: the number of corners`);
        // The program leaves points and lines as they are.
        if (!old.kind.endsWith("Mesh")) {
            if (oldCorners.join() !== madeCorners.join()) differ(`primitive ${number}: ${old.kind}`);
            return;
        }
        found.triangles += Math.floor(oldCorners.length / 3);
        const [some, others] = [triangles(oldCorners), triangles(madeCorners)];
        const isSame = some.size === others.size && [...some].every(([key, count]) => others.get(key) === count);
        if (!isSame) differ(`primitive ${number}: triangles`);
    });
    return found;
}
