// Levels of detail that `meshweft levels` adds to scenes: the Khronos validator finds nothing new, all that was there
// stays, three.js draws each level in the place of the full nodes, at rest and animated, and pictures of a level look
// like those of the full scene from where its error is one pixel.
//
// Usage: node levels.mjs MESHWEFT DATA_FOLDER [FOLDER_FOR_RESULTS]

import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

import { openPage } from "./browser.mjs";
import { Glb } from "./glb.mjs";
import { buffersOf, findingChanges, plainValues } from "./kept.mjs";
import { copyAround, filesBelow, findings, isError, isGlb, jsonOf, names } from "./reading.mjs";
import { differences, load } from "./three.mjs";

const [program, data, kept] = process.argv.slice(2);
const run = promisify(execFile);
const here = dirname(fileURLToPath(import.meta.url));
const RATIOS = [0.5, 0.25, 0.1];
const INFORMATION = 2;
/** What is new to the validator, and so what only that names. */
const OF_LEVELS = ["UNSUPPORTED_EXTENSION", "UNUSED_OBJECT"];
const FRAME = 1920 * 1080;
/** More of a frame may not differ where a level takes the place of the full scene. */
const MOST_OF_FRAME = 0.01;
const TRIANGLES = 4;

const problems = [];
const refused = [];
const rows = [];
const counted = { scenes: 0, findings: 0, again: [], triangles: 0, drawn: 0, animations: 0, moved: 0 };

/** The nodes that stand in for one, fine to coarse. */
const standsOf = (node) => node.extensions?.MSFT_lod?.ids ?? [];
/** The one at a level. */
const idAt = (ids, level) => ids[Math.min(level, ids.length) - 1];

/** The bytes of a file's JSON. */
async function textOf(file) {
    const bytes = await readFile(file);
    return (isGlb(file) ? new Glb(bytes).jsonBytes : bytes).toString();
}

/** Values that are not where they were, or written in another way. */
function otherValues(before, after) {
    const [plain, now] = [plainValues(before), plainValues(after)];
    const lengths = [...now.keys()].filter((pointer) => /^\/buffers\/\d+\/byteLength$/.test(pointer));
    // One buffer is longer.
    const grown = lengths.find((pointer) => Number(now.get(pointer)) > Number(plain.get(pointer)));
    // The data of a buffer is compared as bytes.
    const isData = (text) => text.startsWith('"data:');
    const others = [...plain].filter(([pointer, text]) => {
        const other = now.get(pointer);
        return other !== text && pointer !== grown && !(isData(text) && other !== undefined && isData(other));
    });
    return others.map(([pointer, text]) => `${pointer}: ${text} | ${now.get(pointer)}`);
}

/** For each buffer which of its bytes are vertices and indices of triangles. */
function movable(json, buffers) {
    const isMovable = buffers.map((bytes) => new Uint8Array(bytes?.length ?? 0));
    const triangles = (json.meshes ?? []).flatMap(({ primitives }) => primitives);
    const used = triangles.filter(({ mode = TRIANGLES }) => mode === TRIANGLES).flatMap((primitive) => [
        primitive.indices,
        ...[primitive.attributes, ...(primitive.targets ?? [])].flatMap(Object.values),
    ]);
    for (const number of new Set(used)) {
        const accessor = json.accessors[number];
        if (accessor?.bufferView === undefined) continue;
        const { buffer, byteOffset = 0, byteStride } = json.bufferViews[accessor.bufferView];
        const size = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 }[accessor.componentType];
        const element = size * { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[accessor.type];
        const stride = byteStride ?? element;
        for (let i = 0, at = byteOffset + (accessor.byteOffset ?? 0); i < accessor.count; i++, at += stride) {
            isMovable[buffer].fill(1, at, at + element);
        }
    }
    return isMovable;
}

/** Bytes that are other ones, but for vertices and indices. */
function otherBytes(before, after, json) {
    const isMovable = movable(json, before);
    return before.flatMap((bytes, buffer) => {
        const length = Math.min(bytes?.length ?? 0, json.buffers[buffer].byteLength);
        for (let at = 0; at < length; at++) {
            if (bytes[at] !== after[buffer]?.[at] && !isMovable[buffer][at]) return [`buffer ${buffer}: byte ${at}`];
        }
        return [];
    });
}

/** A .gltf with its buffers read, under the interface of a GLB. */
function opened(json, buffers) {
    const empty = Buffer.concat([Buffer.alloc(12), Buffer.from([2, 0, 0, 0]), Buffer.alloc(4), Buffer.from("{}")]);
    return Object.assign(new Glb(empty), { json, buffers });
}

/** What is stored with each vertex of a primitive, as text. */
function storedVertices(glb, { attributes, targets = [] }) {
    const sets = [attributes, ...targets];
    const columns = sets.map((set) => Object.keys(set).sort().map((name) => [name, glb.elements(set[name])]));
    const count = columns[0][0][1].length;
    return Array.from({ length: count }, (_, vertex) =>
        JSON.stringify(columns.map((set) => set.map(([name, elements]) => [name, elements[vertex]]))),
    );
}

/** Whether all vertices of a primitive are vertices of another one, with all that is stored. */
function areCopies(glb, primitive, source) {
    const stored = new Set(storedVertices(glb, source));
    return storedVertices(glb, primitive).every((vertex) => stored.has(vertex));
}

const hasVerticesOf = (source) => (primitive) => primitive.attributes.POSITION === source.attributes.POSITION;

/** What is not right about the levels of a file's meshes, whose JSON was `before`. */
function wrongLevels(json, before, buffers) {
    const wrong = [];
    const glb = opened(json, buffers);
    for (const [number, node] of json.nodes.entries()) {
        const ids = standsOf(node);
        const where = `/nodes/${number}`;
        if (ids.length === 0) continue;
        const coverage = node.extras?.MSFT_screencoverage ?? [];
        const isFalling = coverage.every((share, i) => share >= 0 && share <= 1 && (i === 0 || share <= coverage[i - 1]));
        if (coverage.length !== ids.length + 1 || !isFalling) wrong.push(`${where}: coverage ${coverage}`);
        const full = json.meshes[node.mesh].primitives;
        let last = { error: 0, faces: Infinity, vertices: Infinity };
        for (const [place, id] of ids.entries()) {
            if (id < before.nodes.length) wrong.push(`${where}: level ${place + 1} is a node that was there`);
            const { primitives, extras } = json.meshes[json.nodes[id].mesh];
            const { level, error, vertices } = extras.MESHWEFT_level;
            const made = { error, faces: 0, vertices: 0 };
            if (level !== place + 1 || primitives.length !== full.length) wrong.push(`${where}: level ${place + 1} is another`);
            primitives.forEach(({ attributes, indices, material, mode, targets }, i) => {
                const source = full[i];
                const own = [attributes, material, mode, targets];
                const theirs = [source.attributes, source.material, source.mode, source.targets];
                const isSame = JSON.stringify(own) === JSON.stringify(theirs);
                const isCopied = source.indices === undefined && material === source.material && mode === source.mode;
                const isKnown = isSame || (isCopied && areCopies(glb, primitives[i], source));
                if (!isKnown) wrong.push(`${where}: level ${level} draws other vertices`);
                if (vertices[i] === null) return;
                const used = glb.elements(indices).map(([index]) => index);
                const needed = used.reduce((most, index) => Math.max(most, index + 1), 0);
                // Where several primitives share a view, it is what all of them need.
                const isShared = before.meshes.flatMap((mesh) => mesh.primitives).filter(hasVerticesOf(source)).length > 1;
                const isTrue = isShared ? needed <= vertices[i] : needed === vertices[i];
                if (!isTrue) wrong.push(`${where}: level ${level} needs ${needed} vertices, not ${vertices[i]}`);
                made.faces += used.length / 3;
                made.vertices += needed;
            });
            const isCoarser = made.error >= last.error && made.faces <= last.faces && made.vertices <= last.vertices;
            if (!isCoarser) wrong.push(`${where}: level ${level} is not coarser: ${JSON.stringify([last, made])}`);
            last = made;
        }
    }
    return wrong;
}

/** How many triangles a file says are drawn at a level, 0 the full one. */
function trianglesAt(json, level) {
    const count = ({ mode = TRIANGLES, indices, attributes }) => {
        const corners = json.accessors[indices ?? attributes.POSITION].count;
        if (mode === TRIANGLES) return Math.floor(corners / 3);
        return mode > TRIANGLES ? corners - 2 : 0;
    };
    const below = (number) => {
        const ids = standsOf(json.nodes[number]);
        const { mesh, children = [] } = json.nodes[level > 0 && ids.length > 0 ? idAt(ids, level) : number];
        const primitives = mesh === undefined ? [] : json.meshes[mesh].primitives;
        return [...primitives.map(count), ...children.map(below)].reduce((sum, own) => sum + own, 0);
    };
    return json.scenes[json.scene ?? 0].nodes.map(below).reduce((sum, own) => sum + own, 0);
}

/** What stays of the file, and what was added. */
async function checkFile(source, result, name) {
    const wrong = [];
    const [before, after] = [await jsonOf(source), await jsonOf(result)];
    const [old, now] = [await buffersOf(source, before), await buffersOf(result, after)];
    wrong.push(...otherValues(await textOf(source), await textOf(result)));
    wrong.push(...otherBytes(old, now, before));
    wrong.push(...wrongLevels(after, before, now));

    // As three.js loads it: the meshes that were there, and after them others.
    const [full, levelled] = [await load(source), await load(result)];
    levelled.primitives.length = Math.min(levelled.primitives.length, full.primitives.length);
    const found = differences(full, { ...levelled, rest: full.rest });
    wrong.push(...found.problems.map((text) => `three.js: ${text}`));
    counted.triangles += found.triangles;

    const [earlier, later] = [await findings(source, name), await findings(result, name)];
    // Vertices have other numbers.
    const worded = ({ message }) => message.replace(/\d+/g, "…");
    const { lost, again, added } = findingChanges(earlier.messages, later.messages, before, worded);
    const isOfLevels = ({ severity, code }) => severity === INFORMATION && OF_LEVELS.includes(code);
    const where = ({ code, pointer, message }) => `validator: ${code} at ${pointer}: ${message}`;
    wrong.push(...lost.map((finding) => `${where(finding)}: not found any more`));
    wrong.push(...added.filter((finding) => !isOfLevels(finding)).map(where));
    counted.findings += earlier.messages.length;
    counted.again.push(...again.filter((finding) => !isOfLevels(finding)).map(({ code }) => `${code} in ${name}`));
    problems.push(...wrong.map((text) => `${name}: ${text}`));
    return after;
}

/** What three.js draws of it. */
async function checkDrawn(page, uri, name, json) {
    const levelled = await page.evaluate((one) => window.load(one), uri);
    const nodes = json.nodes.filter((node) => standsOf(node).length > 0);
    const most = Math.max(...nodes.map((node) => standsOf(node).length));
    if (levelled === 0) problems.push(`${name}: three.js draws no node that has levels`);
    for (let level = 0; level <= most; level++) {
        const expected = trianglesAt(json, level);
        const looks = [await page.evaluate((one) => window.drawnAt(one), level)];
        const moved = await page.evaluate((one) => window.movedAt(one), level);
        for (const { triangles, covered } of [...looks, ...moved]) {
            if (triangles !== expected) problems.push(`${name}: level ${level}: ${triangles} triangles drawn of ${expected}`);
            if (covered < 1000) problems.push(`${name}: level ${level}: nothing is seen`);
            counted.drawn += 1;
        }
        for (const [animation, { apart, moved: count }] of moved.entries()) {
            counted.animations += level > 0;
            counted.moved += level > 0 ? count : 0;
            if (apart.length) problems.push(`${name}: level ${level}: animation ${animation} leaves nodes ${apart} behind`);
        }
        if (level === 0) continue;
        const errors = json.meshes.map(({ extras }) => extras?.MESHWEFT_level?.error ?? null);
        const found = await page.evaluate(([...all]) => window.compare(...all), [level, errors]);
        const share = (part) => Math.max(...found.views.map(part));
        rows.push({
            name,
            level,
            kept: expected / trianglesAt(json, 0),
            pixels: found.pixels,
            radius: found.radius,
            ofObject: share(({ differing, covered }) => differing / Math.max(covered, 1)),
            ofFrame: share(({ differing }) => differing / FRAME),
        });
    }
}

async function check(page, source, name, scratch) {
    const folder = join(scratch, String(counted.scenes));
    await mkdir(folder, { recursive: true });
    if (!isGlb(source)) await copyAround(source, folder);
    const result = join(folder, basename(source));
    try {
        await run(program, ["levels", source, "-o", result, "--ratios", RATIOS.join(), "--quiet"]);
    } catch (error) {
        if (error.code !== 1) throw new Error(`${name}: meshweft ended with ${error.code}: ${error.stderr}`);
        refused.push(`${name}: ${error.stderr.trim().replace(/\s+/g, " ")}`);
        return;
    }
    counted.scenes += 1;
    const json = await checkFile(source, result, name);
    await checkDrawn(page, `/${relative(scratch, result)}`, name, json);
}

/** The pictures, a row a level, and the worst. */
function printPictures() {
    const percent = (share) => `${(100 * share).toFixed(2)} %`;
    console.log("| scene | level | faces | error, pixels | radius, pixels | of the object | of the frame |");
    console.log("|---|--:|--:|--:|--:|--:|--:|");
    for (const { name, level, kept: faces, pixels, radius, ofObject, ofFrame } of rows) {
        const figures = [percent(faces), pixels.toFixed(2), radius.toFixed(0), percent(ofObject), percent(ofFrame)];
        console.log(`| ${[name, level, ...figures].join(" | ")} |`);
    }
    const worst = (part) => rows.reduce((most, row) => (row[part] > most[part] ? row : most), rows[0]);
    const told = (part) => `${percent(worst(part)[part])} (${worst(part).name}, level ${worst(part).level})`;
    const within = (part) => rows.filter((row) => row[part] <= MOST_OF_FRAME).length;
    console.log(
        `levels, pictures: pixels that differ by more than 8 of 255, the worst of six directions: of the pixels covered at ` +
            `most ${told("ofObject")}, within 1 % in ${within("ofObject")} of ${rows.length} levels; of the frame ` +
            `of 1920 by 1080 at most ${told("ofFrame")}, within 1 % in ${within("ofFrame")}`,
    );
}

const scratch = kept ?? (await mkdtemp(join(tmpdir(), "meshweft-levels-")));
await mkdir(scratch, { recursive: true });
const faults = [];
const script = await readFile(join(here, "levels_page.js"), "utf8");
const { page, close } = await openPage(script, scratch, faults);
try {
    const files = await filesBelow(join(data, "gltf"));
    for (const file of files) await check(page, file, relative(join(data, "gltf"), file), scratch);
    if (counted.scenes === 0) problems.push("no scene got levels");
    if (counted.animations === 0) problems.push("no scene with levels is animated");
    for (const { name, level, ofFrame } of rows) {
        if (ofFrame > MOST_OF_FRAME) problems.push(`${name}: level ${level}: ${(100 * ofFrame).toFixed(2)} % of the frame differ`);
    }
    if (!rows.some(({ ofObject }) => ofObject > 0)) problems.push("no level looks other than the full scene: pictures cannot tell");
    problems.push(...faults);
    for (const problem of problems.slice(0, 100)) console.log(`DIFFERENT: ${problem}`);
    if (rows.length > 0) printPictures();
    console.log(
        `levels: ${counted.scenes} scenes, ${counted.triangles} triangles of the full meshes as they were; ` +
            `without levels: ${refused.length}${names(refused)}`,
    );
    console.log(
        `levels, Khronos validator: ${counted.findings} findings, the same with levels but for ${OF_LEVELS.join(" and ")}; ` +
            `found again in what is new: ${counted.again.length}${names([...new Set(counted.again)])}`,
    );
    console.log(
        `levels, three.js: ${counted.drawn} times drawn, ${counted.animations} animations of levels, which moved ` +
            `${counted.moved} nodes as the full ones`,
    );
} finally {
    await close();
    if (!kept) await rm(scratch, { recursive: true, force: true });
}
if (problems.length > 0) process.exitCode = 1;
