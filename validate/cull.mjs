// The Khronos validator and three.js read every glTF before and after it got culling tables, and after that was
// optimised: nothing new is found but information on what is not known, the triangles are the same, and a reading of
// the tables that shares nothing with the library leaves out no triangle that an eye sees.
//
// Usage: node cull.mjs MESHWEFT DATA_FOLDER

import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, dirname, join, relative } from "node:path";
import { promisify } from "node:util";

import { Glb } from "./glb.mjs";
import { make } from "./made.mjs";
import { seeded } from "./random.mjs";
import { copyAround, filesBelow, findings, isError, isGlb, jsonOf, names } from "./reading.mjs";
import { differences, load } from "./three.mjs";

const [program, data] = process.argv.slice(2);
const run = promisify(execFile);
const NAME = "MESHWEFT_culling";
const INFORMATION = 2;
/** Refused though the validator finds no error: names that systems read in different ways. */
const REFUSED_BY_DESIGN = ["reports/uri-backslash/m.gltf"];
/** What the validator may find of a table: it does not know the extension, and so nobody who reads the accessors. */
const OF_TABLES = ["UNSUPPORTED_EXTENSION", "UNUSED_OBJECT"];
/** Eyes from which each table is looked at, half of them positions. */
const EYES = 24;
/** Larger meshes are left to the tests of the library. */
const MOST_FACES = 30_000;

const problems = [];
const refused = [];
const unreadable = [];
const found = { scenes: 0, tables: 0, findings: 0, information: 0, triangles: 0, judged: 0, leftOut: 0 };

/** Which kinds are found how often. Numbers in messages may change with an order, so kinds are compared. */
function kinds({ messages }) {
    const counts = new Map();
    for (const { severity, code } of messages) {
        const kind = `${severity} ${code}`;
        counts.set(kind, (counts.get(kind) ?? 0) + 1);
    }
    return counts;
}

function compareFindings(name, before, after) {
    const [old, now] = [kinds(before), kinds(after)];
    for (const kind of new Set([...old.keys(), ...now.keys()])) {
        const [earlier, count] = [old.get(kind) ?? 0, now.get(kind) ?? 0];
        found.findings += count;
        const [severity, code] = kind.split(" ");
        const isOfTable = Number(severity) >= INFORMATION && OF_TABLES.includes(code);
        if (isOfTable) found.information += count - earlier;
        // Of indices out of range fewer or more may be told one by one.
        if (count > earlier && !isOfTable) problems.push(`${name}: ${code} ${count} times, before ${earlier} times`);
    }
}

const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

/** Whether a cluster with these planes may be left out, as the text of the extension says. */
function isHidden(planes, { center, reach }, eye, w) {
    const from = minus(eye, center.map((x) => w * x));
    const size = from.reduce((sum, x) => sum + Math.abs(x), 0) + 4 * w * reach;
    return planes.every(([x, y, z, o]) => dot([x, y, z], from) + o * w < -8e-6 * size);
}

/** Looks at the table of a primitive from some sides. */
function judge(name, glb, primitive, random) {
    const table = primitive.extensions[NAME];
    const starts = glb.elements(table.starts).map(([start]) => start);
    const planes = glb.elements(table.planes);
    const positions = glb.elements(primitive.attributes.POSITION);
    const indices =
        primitive.indices === undefined ? positions.map((_, i) => i) : glb.elements(primitive.indices).map(([i]) => i);
    const faceCount = indices.length / 3;
    const isSound =
        starts[0] === 0 &&
        starts.at(-1) === faceCount &&
        planes.length === 4 * (starts.length - 1) &&
        starts.every((start, i) => i === 0 || start > starts[i - 1]);
    if (!isSound) {
        problems.push(`${name}: the starts do not rise from 0 to ${faceCount}`);
        return;
    }
    const far = indices.some((vertex) => Math.hypot(...minus(positions[vertex], table.center)) > table.reach * (1 + 1e-6));
    if (far) problems.push(`${name}: a vertex is out of reach`);
    for (let view = 0; view < EYES && faceCount <= MOST_FACES; view++) {
        const w = view % 2;
        const way = [0, 1, 2].map(() => 2 * random() - 1);
        const distance = [1.05, 2, 6][view % 3] * table.reach;
        const eye = w === 1 ? way.map((x, i) => table.center[i] + distance * x) : way;
        for (let cluster = 0; cluster + 1 < starts.length; cluster++) {
            found.judged += starts[cluster + 1] - starts[cluster];
            if (!isHidden(planes.slice(4 * cluster, 4 * cluster + 4), table, eye, w)) continue;
            for (let face = starts[cluster]; face < starts[cluster + 1]; face++) {
                const [a, b, c] = [0, 1, 2].map((corner) => positions[indices[3 * face + corner]]);
                const normal = cross(minus(b, a), minus(c, a));
                const toEye = minus(eye, a.map((x) => w * x));
                const slack = 1e-9 * Math.hypot(...normal) * Math.hypot(...toEye);
                found.leftOut += 1;
                if (dot(normal, toEye) > slack) problems.push(`${name}: face ${face} is seen and left out`);
            }
        }
    }
}

async function check(source, name, scratch) {
    const result = async (folder, verb, from) => {
        await mkdir(folder, { recursive: true });
        if (!isGlb(from)) await copyAround(from, folder);
        const to = join(folder, basename(from));
        await run(program, [...verb, from, "-o", to, "--quiet"]);
        return to;
    };
    const before = await findings(source, name);
    let culled;
    try {
        culled = await result(join(scratch, "culled"), ["cull", "build"], source);
    } catch (error) {
        if (error.code !== 1) throw new Error(`${name}: meshweft ended with ${error.code}: ${error.stderr}`);
        refused.push(name);
        const isSound = !before.messages.some(isError) && !REFUSED_BY_DESIGN.includes(name);
        if (isSound) problems.push(`${name}: refused, but valid: ${error.stderr}`);
        return;
    }
    const ordered = await result(join(scratch, "ordered"), ["optimize", "--allow-worse"], culled);
    found.scenes += 1;
    if (before.messages.some(({ code }) => code === "INVALID_JSON")) return;

    const old = await load(source);
    if (old.error !== undefined) unreadable.push(name);
    for (const [what, file] of [["culled", culled], ["ordered", ordered]]) {
        compareFindings(`${name}, ${what}`, before, await findings(file, name));
        const now = differences(old, await load(file));
        problems.push(...now.problems.map((text) => `${name}, ${what}: three.js: ${text}`));
        found.triangles += now.triangles;
        const json = await jsonOf(file);
        const primitives = (json.meshes ?? []).flatMap(({ primitives }) => primitives);
        const withTable = primitives.filter(({ extensions }) => extensions?.[NAME]);
        found.tables += withTable.length;
        const isUsed = (json.extensionsUsed ?? []).includes(NAME);
        if (isUsed !== withTable.length > 0) problems.push(`${name}, ${what}: extensionsUsed`);
        if ((json.extensionsRequired ?? []).includes(NAME)) problems.push(`${name}, ${what}: extensionsRequired`);
        if (withTable.length === 0) continue;

        // A table of a .gltf is read with its buffers as one GLB would be.
        const glb = isGlb(file) ? new Glb(await readFile(file)) : await opened(file, json);
        const random = seeded(found.scenes);
        for (const primitive of withTable) judge(`${name}, ${what}`, glb, primitive, random);
    }
}

/** A .gltf with its buffers read, under the interface of a GLB. */
async function opened(file, json) {
    const buffers = (json.buffers ?? []).map(async ({ uri }) => {
        if (uri.startsWith("data:")) return Buffer.from(uri.slice(uri.indexOf(",") + 1), "base64");
        return readFile(join(dirname(file), decodeURIComponent(uri)));
    });
    const empty = Buffer.concat([Buffer.alloc(12), Buffer.from([2, 0, 0, 0]), Buffer.alloc(4), Buffer.from("{}")]);
    const glb = new Glb(empty);
    [glb.json, glb.buffers] = [json, await Promise.all(buffers)];
    return glb;
}

const scratch = await mkdtemp(join(tmpdir(), "meshweft-cull-"));
try {
    const made = join(scratch, "made.glb");
    await writeFile(made, make());
    const files = [[made, "made.glb"]];
    for (const folder of ["gltf", "reports"]) {
        const below = await filesBelow(join(data, folder));
        if (below.length === 0) problems.push(`no files in ${folder}`);
        files.push(...below.map((file) => [file, relative(data, file)]));
    }
    let number = 0;
    for (const [file, name] of files) {
        const folder = join(scratch, String((number += 1)));
        await check(file, name, folder);
        await rm(folder, { recursive: true, force: true });
    }
    if (found.leftOut === 0) problems.push("no table leaves anything out");
    for (const problem of problems.slice(0, 100)) console.log(`DIFFERENT: ${problem}`);
    console.log(
        `cull: ${found.scenes} scenes, ${found.tables} tables before and after they were optimised; refused by meshweft: ` +
            `${refused.length}${names(refused)}; not loaded by three.js even before: ${unreadable.length}${names(unreadable)}`,
    );
    console.log(
        `cull, Khronos validator: ${found.findings} findings, new are ${found.information} times ` +
            `${OF_TABLES.join(" or ")} and no others; three.js: ${found.triangles} triangles, the same; of ${found.judged} ` +
            `judged ${found.leftOut} are left out, none of them seen`,
    );
    if (problems.length > 0) process.exitCode = 1;
} finally {
    await rm(scratch, { recursive: true, force: true });
}
