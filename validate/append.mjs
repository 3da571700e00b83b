// The Khronos validator and three.js read every glTF before and after meshes were added to it: what
// was there must be as it was, and the new meshes must be drawn where they belong. Files made from
// nothing must be without fault.
//
// Usage: node append.mjs MESHWEFT_APPEND DATA_FOLDER [KEEP_FOLDER]

import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join, relative } from "node:path";
import { promisify } from "node:util";

import { compareDrawn } from "./drawn.mjs";
import { buffersOf, findingChanges, notContained } from "./kept.mjs";
import { make } from "./made.mjs";
import { copyAround, filesBelow, findings, isError, isGlb, jsonOf, names } from "./reading.mjs";
import { loadScene } from "./three.mjs";

const [program, data, kept] = process.argv.slice(2);
const run = promisify(execFile);
const INFORMATION = 2;
/** Refused though the validator finds no error: names that systems read in different ways. */
const REFUSED_BY_DESIGN = ["reports/uri-backslash/m.gltf"];

/** Counts and differences of all files. */
class Tally {
    scenes = 0;
    refused = [];
    refusedValid = [];
    withoutShared = [];
    unreadable = [];
    repaired = [];
    shared = 0;
    triangles = 0;
    hit = 0;
    rays = 0;
    flat = [];
    undrawn = [];
    skinned = 0;
    morphed = 0;
    interleaved = 0;
    findings = 0;
    information = [0, 0];
    again = [];
    problems = [];

    print() {
        for (const name of this.refusedValid) this.problems.push(`${name}: refused, but valid`);
        for (const kind of ["skinned", "morphed", "interleaved"]) {
            if (this[kind] === 0) this.problems.push(`no ${kind} mesh was shared`);
        }
        for (const problem of this.problems) console.log(`DIFFERENT: ${problem}`);
        for (const again of this.again) console.log(`found again through what is shared: ${again}`);
        console.log(
            `append: ${this.scenes} scenes, ${this.shared} meshes over shared vertices (${this.skinned} skinned, ` +
                `${this.morphed} morphed, ${this.interleaved} interleaved) and ${this.scenes} of their own, ` +
                `${this.triangles} triangles; ` +
                `refused by meshweft: ${this.refused.length}${names(this.refused)}; no mesh that can be shared: ` +
                `${this.withoutShared.length}${names(this.withoutShared)}`,
        );
        console.log(
            `append, Khronos validator: ${this.findings} findings, the same before and after but for ` +
                `${this.again.length} found again and information (${this.information.join(" before, ")} after)`,
        );
        console.log(
            `append, three.js: ${this.hit} triangles hit by ${this.rays} rays, left out: meshes without a triangle ` +
                `that has an area ${this.flat.length}${names(this.flat)}, sources that the default scene does not ` +
                `draw ${this.undrawn.length}${names(this.undrawn)}, not loaded by three.js even before: ` +
                `${this.unreadable.length}${names(this.unreadable)}; no valid JSON before, valid after: ` +
                `${this.repaired.length}${names(this.repaired)}`,
        );
    }
}

/** What of the old file does not stand where it stood. */
async function notKept(source, result, before, after) {
    const grown = new Set();
    const problems = notContained(before, after, "", grown);
    if (grown.size > 1) problems.push(`/buffers: ${[...grown]} have grown`);
    const [old, now] = [await buffersOf(source, before), await buffersOf(result, after)];
    old.forEach((bytes, number) => {
        if (!bytes) return;
        const length = Math.min(bytes.length, before.buffers[number].byteLength);
        const isKept = now[number]?.subarray(0, length).equals(bytes.subarray(0, length));
        if (!isKept) problems.push(`/buffers/${number}: other bytes`);
    });
    now.forEach((bytes, number) => {
        const promised = after.buffers[number].byteLength;
        const isPromised = before.buffers?.[number]?.byteLength === promised;
        if (!isPromised && !(bytes?.length >= promised)) problems.push(`/buffers/${number}/byteLength: too much`);
    });
    return problems;
}

/** Compares findings; new ones are allowed where they are old ones seen through new elements. */
function compareFindings(name, before, after, json, tally) {
    const weighty = ({ messages }) => messages.filter(({ severity }) => severity !== INFORMATION);
    const [old, now] = [weighty(before), weighty(after)];
    tally.findings += old.length;
    tally.information[0] += before.messages.length - old.length;
    tally.information[1] += after.messages.length - now.length;
    const where = ({ code, pointer, offset, message }) => `${name}: ${code} at ${pointer ?? offset}: ${message}`;
    const { lost, again, added } = findingChanges(old, now, json);
    for (const finding of lost) tally.problems.push(`${where(finding)}: not found any more`);
    tally.again.push(...again.map(where));
    tally.problems.push(...added.map((finding) => `validator: ${where(finding)}`));
}

/** Adds to one file and compares. */
async function check(source, name, folder, tally) {
    await rm(folder, { recursive: true, force: true });
    await mkdir(folder, { recursive: true });
    // Textures are not written by the program, so the other files of the source's folder are copied.
    if (!isGlb(source)) await copyAround(source, folder);
    const result = join(folder, basename(source));
    let told;
    try {
        const { stdout } = await run(program, ["scene", source, result]);
        told = stdout.replace(/\n$/, "").split("\n").map((line) => line.split("\t"));
    } catch (error) {
        if (error.code !== 1) throw new Error(`${name}: ended with ${error.code}: ${error.stderr}`);
        tally.refused.push(name);
        const { messages } = await findings(source, name);
        if (!messages.some(isError) && !REFUSED_BY_DESIGN.includes(name)) tally.refusedValid.push(`${name}: ${error.stderr.trim()}`);
        return;
    }
    tally.scenes += 1;
    tally.shared += told.length - 1;
    tally.triangles += told.reduce((sum, [, faces]) => sum + Number(faces), 0);
    if (told.length === 1) tally.withoutShared.push(name);

    // A source that no JSON parser takes, but the library does, has nothing to compare with; its result is read.
    const isBroken = ({ messages }) => messages.some(({ code }) => code === "INVALID_JSON");
    const [found, foundAgain] = [await findings(source, name), await findings(result, name)];
    if (isBroken(found)) {
        if (isBroken(foundAgain)) tally.problems.push(`${name}: its JSON is still not valid`);
        else tally.repaired.push(name);
        return;
    }

    const [before, after] = [await jsonOf(source), await jsonOf(result)];
    const problems = await notKept(source, result, before, after);
    compareFindings(name, found, foundAgain, before, tally);

    const [old, now] = [await loaded(source), await loaded(result)];
    if (old.error !== undefined) tally.unreadable.push(name);
    if (old.error !== now.error) problems.push(`three.js: ${old.error ?? "loaded"} | ${now.error ?? "loaded"}`);
    if (now.gltf && !now.gltf.scene) problems.push("/scenes: nothing is drawn");
    else if (now.gltf) problems.push(...compareDrawn({ name, told, before, after, old, now, tally }));
    tally.problems.push(...problems.map((text) => `${name}: ${text}`));
}

const loaded = (file) => loadScene(file).catch((error) => ({ error: String(error.message ?? error), primitives: [] }));

/** The files that were made from nothing. */
async function checkCreated(folder, tally) {
    await mkdir(folder, { recursive: true });
    await run(program, ["create", folder]);
    for (const name of ["new.glb", "new.gltf"]) {
        const { messages } = await findings(join(folder, name), name);
        // An attribute that no material needs is not a fault.
        const faults = messages.filter(({ severity, code }) => severity !== INFORMATION || !code.startsWith("UNUSED_"));
        for (const { code, pointer, message } of faults) tally.problems.push(`${name}: ${code} at ${pointer}: ${message}`);
        const { gltf, primitives } = await loadScene(join(folder, name));
        const drawn = [];
        gltf.scene.traverse((part) => drawn.push(...(part.isMesh ? [part] : [])));
        const isDrawn = primitives.length === 1 && drawn.length === 1 && drawn[0].geometry === primitives[0].geometry;
        if (!isDrawn) tally.problems.push(`${name}: three.js draws ${drawn.length} meshes`);
        const { attributes, index, morphAttributes } = primitives[0].geometry;
        const numbers = (attribute) => Array.from({ length: attribute.count }, (_, i) => [0, 1, 2].map((c) => attribute.getComponent(i, c)));
        const found = {
            position: numbers(attributes.position),
            color: numbers(attributes.color).map((color) => color.map((c) => Math.round(255 * c))),
            index: [...index.array],
            attributes: Object.keys(attributes).length,
            morphs: Object.values(morphAttributes).map((list) => list.length),
        };
        const expected = {
            position: [[Math.fround(0.1), 0, 0], [1, 0, 0.25], [0, 1, 0.5], [1, 1, 0.75]],
            color: [[255, 0, 0], [0, 254, 1], [2, 3, 253], [9, 8, 7]],
            index: [0, 1, 2, 2, 1, 3],
            attributes: 11,
            morphs: [2, 2],
        };
        if (JSON.stringify(found) !== JSON.stringify(expected)) {
            tally.problems.push(`${name}: three.js: ${JSON.stringify(found)}`);
        }
        console.log(`append: ${name} from nothing: ${messages.length - faults.length} findings, all of unused attributes`);
    }
    for (const [name, expected] of [["plain.glb", 1], ["several.glb", 2], ["several.gltf", 2]]) {
        const { messages } = await findings(join(folder, name), name);
        // A node of an empty mesh, and faces without an area, are what was given.
        const given = ["NODE_EMPTY", "ACCESSOR_INDEX_TRIANGLE_DEGENERATE"];
        const faults = messages.filter(({ code }) => !given.includes(code));
        for (const { code, pointer, message } of faults) tally.problems.push(`${name}: ${code} at ${pointer}: ${message}`);
        const { primitives } = await loadScene(join(folder, name));
        if (primitives.length !== expected) tally.problems.push(`${name}: three.js loads ${primitives.length} meshes`);
        console.log(`append: ${name} of plain meshes: ${messages.length - faults.length} findings, all of what was given`);
    }
}

const scratch = kept ?? (await mkdtemp(join(tmpdir(), "meshweft-append-")));
try {
    const tally = new Tally();
    await mkdir(scratch, { recursive: true });
    await checkCreated(join(scratch, "created"), tally).catch((error) => tally.problems.push(`created: ${error.message}`));
    const made = join(scratch, "made.glb");
    await writeFile(made, make());
    await check(made, "made.glb", join(scratch, "out"), tally);
    for (const folder of ["gltf", "reports"]) {
        const files = await filesBelow(join(data, folder));
        if (files.length === 0) tally.problems.push(`no files in ${folder}`);
        for (const file of files) await check(file, relative(data, file), join(scratch, "out"), tally);
    }
    tally.print();
    if (tally.problems.length > 0) process.exitCode = 1;
} finally {
    if (!kept) await rm(scratch, { recursive: true, force: true });
}
