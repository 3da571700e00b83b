// three.js reads every VRML: positions, colours and texture coordinates of each corner must be those
// that meshweft reads, bit by bit, and normals where the file has them. The files are those of the test
// data, and one made here that has all of these.
//
// Usage: node attributes_vrml.mjs ATTRIBUTES DATA_FOLDER
//
// ATTRIBUTES is the program of that name in `compare/`.

import { execFile } from "node:child_process";
import { mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";
import { promisify } from "node:util";
import { gunzipSync } from "node:zlib";

import { VRMLLoader } from "three/addons/loaders/VRMLLoader.js";

/** Some servers store a .wrl compressed: the first bytes tell. */
const isGzip = (bytes) => bytes[0] === 0x1f && bytes[1] === 0x8b;

const [program, data] = process.argv.slice(2);
const run = promisify(execFile);
const GOOD_FILES = ["meshes", "gltf"];

/** What three.js calls an attribute. */
const NAMES = { POSITION: "position", NORMAL: "normal", COLOR_0: "color", TEXCOORD_0: "uv" };

/** The bits of the fractions that three.js keeps when it changes colours to its own colour space. */
const KEPT_COLOURS = [0, 0x3f800000];

const MADE = `#VRML V2.0 utf8
Shape { geometry IndexedFaceSet {
    coord Coordinate { point [0 0 0.1, 1 0 0.2, 1 1 0.3, 0 1 0.4] }
    coordIndex [0 1 2 3 -1 0 2 1 -1]
    normal Normal { vector [0 0.6 0.8, 0 1 0] } normalPerVertex FALSE
    color Color { color [1 0 0, 0 1 0, 0 0 1] } colorIndex [0 1 2 1 -1 2 1 0 -1]
    texCoord TextureCoordinate { point [0 0, 1 0, 1 1, 0.3 0.7, 9 9] } texCoordIndex [4 1 2 3 -1 0 1 2 -1]
} }
Shape { geometry IndexedFaceSet {
    coord Coordinate { point [0 0 0.5, 1 0 0.6, 1 1 0.7, 0 1 0.8] } coordIndex [3 1 2 -1 0 1 3]
    normal Normal { vector [0 0 1, 0 1 0, 1 0 0] } normalIndex [0 1 2 -1 2 1 0]
    texCoord TextureCoordinate { point [0 0.1, 1 0.2, 1 0.9, 0.3 0.7] }
} }
`;

const tally = { files: 0, meshes: 0, attributes: 0, numbers: 0, leftOut: new Map(), problems: [] };

function leaveOut(what, count = 1) {
    tally.leftOut.set(what, (tally.leftOut.get(what) ?? 0) + count);
}

async function filesBelow(folder) {
    const entries = await readdir(folder, { recursive: true, withFileTypes: true });
    const files = entries.filter((entry) => entry.isFile()).map((entry) => join(entry.parentPath, entry.name));
    return files.filter((file) => /\.(wrl|vrml)(\.gz)?$/.test(file)).sort();
}

/** The meshes that meshweft reads; null if it refuses the file. */
async function ours(file, name, scratch) {
    const path = join(scratch, "values");
    const ran = await run(program, [file, path], { maxBuffer: 1 << 28 }).catch((error) => error);
    if (ran.code === 1) {
        const [folder] = name.split("/");
        if (GOOD_FILES.includes(folder)) tally.problems.push(`${name}: ${ran.stderr}`);
        leaveOut(`files of ${folder}/ refused by meshweft`);
        return null;
    }
    if (ran instanceof Error) throw ran;

    const content = await readFile(path);
    const meshes = [];
    let at = 0;
    for (const text of ran.stdout.split("\n").filter((line) => line)) {
        const line = JSON.parse(text);
        if ("note" in line) continue;
        const bytes = content.subarray(at, (at += line.bytes));
        if ("attribute" in line) meshes.at(-1).attributes.push({ ...line, bytes });
        else meshes.push({ ...line, corners: numbers(bytes), attributes: [] });
    }
    return meshes;
}

/** The 32-bit patterns in some bytes. */
function numbers(bytes) {
    return new Uint32Array(new Uint8Array(bytes).buffer);
}

/** An attribute of meshweft by corner. */
function byCorner(mesh, attribute) {
    const values = numbers(attribute.bytes);
    const { components, domain } = attribute;
    const element = {
        vertex: (corner) => mesh.corners[corner],
        corner: (corner) => corner,
        face: (corner) => Math.floor(corner / 3),
    }[domain];
    return Uint32Array.from({ length: mesh.corners.length * components }, (_, i) => {
        return values[element(Math.floor(i / components)) * components + (i % components)];
    });
}

/** The face sets as three.js reads them, in the order of the file; one that is used twice is one. */
function theirs(text) {
    const geometries = new Set();
    new VRMLLoader().parse(text, "").traverse((node) => {
        if (node.isMesh && node.geometry._type === "mesh") geometries.add(node.geometry);
    });
    return [...geometries];
}

function compare(where, mesh, geometry) {
    tally.meshes += 1;
    for (const attribute of mesh.attributes) {
        const other = geometry.attributes[NAMES[attribute.attribute]];
        const [found, expected] = [byCorner(mesh, attribute), numbers(new Uint8Array(other.array.buffer))];
        if (attribute.attribute === "COLOR_0" && !found.every((number) => KEPT_COLOURS.includes(number))) {
            leaveOut("colours, which three.js changes");
            continue;
        }
        const at = found.findIndex((number, i) => number !== expected[i]);
        if (attribute.error || at >= 0 || found.length !== expected.length) {
            const corner = Math.floor(at / attribute.components);
            const shown = (values) => new Float32Array(values.buffer).slice(corner * attribute.components).slice(0, 3);
            tally.problems.push(
                attribute.error ??
                    `${where}, ${attribute.attribute}: ${found.length} and ${expected.length} numbers; corner ` +
                        `${corner} is ${shown(found)} where three.js has ${shown(expected)}`,
            );
        }
        tally.attributes += 1;
        tally.numbers += found.length;
    }
}

async function check(file, name, scratch) {
    const meshes = await ours(file, name, scratch);
    if (meshes === null) return;
    const stored = await readFile(file);
    const all = theirs((isGzip(stored) ? gunzipSync(stored) : stored).toString());
    // One without faces is not a mesh.
    const geometries = all.filter((geometry) => geometry.attributes.position.count > 0);
    if (geometries.length < all.length) leaveOut("face sets without faces", all.length - geometries.length);
    if (meshes.length !== geometries.length) {
        tally.problems.push(`${name}: ${meshes.length} meshes, and three.js has ${geometries.length}`);
        return;
    }
    meshes.forEach((mesh, i) => compare(`${name}, mesh ${i} (${mesh.name})`, mesh, geometries[i]));
    tally.files += 1;
}

const scratch = await mkdtemp(join(tmpdir(), "meshweft-"));
try {
    for (const file of await filesBelow(data)) await check(file, relative(data, file), scratch);
    const made = join(scratch, "made.wrl");
    await writeFile(made, MADE);
    await check(made, "made.wrl", scratch);
} finally {
    await rm(scratch, { recursive: true });
}

if (tally.attributes === 0) tally.problems.push("no attribute was compared");
for (const problem of tally.problems) console.log(`DIFFERENT: VRML, three.js: ${problem}`);
const leftOut = [...tally.leftOut].map(([what, count]) => `${count} ${what}`).join(", ");
console.log(
    `attributes, VRML, three.js: ${tally.files} files, ${tally.meshes} meshes, ${tally.attributes} attributes ` +
        `(${tally.numbers} numbers by corner) are the same bit by bit; left out: ${leftOut || "nothing"}`,
);
process.exitCode = tally.problems.length > 0 ? 1 : 0;
