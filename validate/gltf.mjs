// The Khronos validator and three.js read every glTF before and after `meshweft optimize`: the
// findings must be the same, and the triangles but for their order, with all attributes.
//
// Usage: node gltf.mjs MESHWEFT DATA_FOLDER

import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join, relative } from "node:path";
import { isDeepStrictEqual, promisify } from "node:util";

import { Glb } from "./glb.mjs";
import { make } from "./made.mjs";
import { copyAround, filesBelow, findings, isChanged, isError, isGlb, jsonOf, names } from "./reading.mjs";
import { differences, load } from "./three.mjs";

const [program, data] = process.argv.slice(2);
const run = promisify(execFile);

/** Findings as sorted lines, each message as `worded`. */
function lines(messages, worded) {
    const text = (finding) =>
        `${finding.severity} ${finding.code} ${finding.pointer ?? finding.offset} ${worded(finding)}`;
    return messages.map(text).sort();
}

/**
 * A finding's message without the numbers that re-ordering changes: which element it is, and how
 * many vertex numbers lie above bounds that are wrong anyway.
 */
function orderFree(finding, indexAccessors) {
    const message = finding.message.replace(/\b(indices \d+\.\.\d+|index \d+)/g, "index …");
    const isWrongBound = /^ACCESSOR_ELEMENT_OUT_OF_(MIN|MAX)_BOUND$/.test(finding.code);
    const [, list, number] = (finding.pointer ?? "").split("/");
    const isIndices = list === "accessors" && indexAccessors.has(Number(number));
    return isWrongBound && isIndices ? message.replace(/contains \d+/, "contains …") : message;
}

/** The numbers of the accessors that hold vertex numbers. */
async function indexAccessors(file) {
    const { meshes = [] } = await jsonOf(file);
    return new Set(meshes.flatMap(({ primitives }) => primitives).map(({ indices }) => indices));
}

/** The first line that only one of two sorted lists has. */
function firstDifference(before, after) {
    if (before.length !== after.length) return `${before.length} findings before, ${after.length} after`;
    const at = before.findIndex((line, i) => line !== after[i]);
    return at < 0 ? undefined : `${before[at]} | ${after[at]}`;
}

/** Counts and differences of all files of one folder. */
class Tally {
    read = 0;
    refused = [];
    refusedValid = [];
    unreadable = [];
    findings = 0;
    renumbered = [];
    geometries = 0;
    triangles = 0;
    draco = 0;
    changed = 0;
    problems = [];

    constructor(what) {
        this.what = what;
    }

    print() {
        const { what } = this;
        for (const name of this.refusedValid) {
            this.problems.push(`${name}: refused, but valid`);
        }
        for (const problem of this.problems) console.log(`DIFFERENT: ${problem}`);
        console.log(
            `${what}: ${this.read} files, ${this.changed} re-ordered, refused by meshweft: ${this.refused.length}, ` +
                `in which the validator finds no error: ${this.refusedValid.length}${names(this.refusedValid)}`,
        );
        console.log(
            `${what}, Khronos validator: ${this.findings} findings, the same before and after but for ` +
                `the numbers of moved elements in ${this.renumbered.length} files${names(this.renumbered)}`,
        );
        console.log(
            `${what}, three.js: ${this.triangles} triangles in ${this.geometries} primitives, not decoded ` +
                `(Draco, compared as bytes): ${this.draco}, not loaded by three.js even before: ` +
                `${this.unreadable.length}${names(this.unreadable)}`,
        );
    }
}

async function check(source, name, scratch, tally) {
    const folder = join(scratch, "out");
    await rm(folder, { recursive: true, force: true });
    await mkdir(folder);
    // The program does not write textures: everything beside the source is copied as well.
    if (!isGlb(source)) await copyAround(source, folder);
    const result = join(folder, basename(source));
    try {
        await run(program, ["optimize", source, "-o", result, "--quiet"]);
    } catch (error) {
        if (error.code !== 1) throw new Error(`${name}: meshweft ended with ${error.code}: ${error.stderr}`);
        tally.refused.push(name);
        const { messages } = await findings(source, name);
        if (!messages.some(isError)) tally.refusedValid.push(name);
        return;
    }
    tally.read += 1;
    if (await isChanged(source, result)) tally.changed += 1;

    const [before, after] = [await findings(source, name), await findings(result, name)];
    const asIs = ({ message }) => message;
    if (firstDifference(lines(before.messages, asIs), lines(after.messages, asIs))) {
        tally.renumbered.push(name);
        const indices = await indexAccessors(source);
        const worded = (finding) => orderFree(finding, indices);
        const problem = firstDifference(lines(before.messages, worded), lines(after.messages, worded));
        if (problem) tally.problems.push(`${name}: validator: ${problem}`);
    }
    if (before.counts !== after.counts) tally.problems.push(`${name}: validator: ${before.counts} | ${after.counts}`);
    tally.findings += before.messages.length;

    const [old, made] = [await load(source), await load(result)];
    if (old.error !== undefined) tally.unreadable.push(name);
    const found = differences(old, made);
    tally.problems.push(...found.problems.map((text) => `${name}: three.js: ${text}`));
    tally.geometries += found.geometries;
    tally.triangles += found.triangles;
    tally.draco += found.draco;
}

/** What should have moved in the made GLB and did not, or the other way round. */
async function notMoved(before, after) {
    const [old, now] = [new Glb(await readFile(before)), new Glb(await readFile(after))];
    const isSame = (accessor) => isDeepStrictEqual(old.elements(accessor), now.elements(accessor));
    return old.json.meshes.flatMap(({ name, primitives: [{ attributes, indices }] }) => {
        const mayMove = !["private", "sparse"].includes(name);
        // An extension that is not known, on the mesh and on the primitive, keeps all of it.
        const facesMayMove = name !== "private";
        const wrong = [];
        if (isSame(indices) === facesMayMove) {
            wrong.push(`made.glb: ${name}: its faces ${facesMayMove ? "did not move" : "moved"}`);
        }
        if (isSame(attributes.POSITION) === mayMove) {
            wrong.push(`made.glb: ${name}: its vertices ${mayMove ? "did not move" : "moved"}`);
        }
        return wrong;
    });
}

const scratch = await mkdtemp(join(tmpdir(), "meshweft-gltf-"));
try {
    const made = join(scratch, "made.glb");
    await writeFile(made, make());
    const { messages } = await findings(made, "made.glb");
    const errors = messages.filter(isError);
    const tallies = [new Tally("made GLB"), new Tally("glTF"), new Tally("malformed glTF")];
    for (const error of errors) tallies[0].problems.push(`made.glb: not valid: ${JSON.stringify(error)}`);
    await check(made, "made.glb", scratch, tallies[0]);
    tallies[0].problems.push(...(await notMoved(made, join(scratch, "out", "made.glb"))));
    for (const [tally, folder] of [
        [tallies[1], join(data, "gltf")],
        [tallies[2], join(data, "malformed")],
    ]) {
        const files = await filesBelow(folder);
        if (files.length === 0) tally.problems.push(`no files in ${folder}`);
        for (const file of files) await check(file, relative(folder, file), scratch, tally);
    }
    for (const tally of tallies) tally.print();
    if (tallies.some(({ problems }) => problems.length > 0)) process.exitCode = 1;
} finally {
    await rm(scratch, { recursive: true, force: true });
}
