// Compresses and decodes meshes with the library as built for another target and natively: the streams, the orders and
// the decoded meshes must be equal, byte for byte, or the errors. Every tier, lossless and with positions of 14 bits.
//
// Usage: node compressed.mjs NAME NATIVE BUILD [--runner COMMAND] [--decoder MODULE] [--soups N]
//            [--spoil code|decoder] [DATA_FOLDER]
//
// BUILD is a module of WebAssembly (`.wasm`), or else the program that NATIVE is, built for another processor, for COMMAND
// to run. MODULE is the small decoder, which must give what NATIVE decodes, from bytes that arrive in pieces. `--spoil`
// changes one byte of one stream, or of what MODULE decodes: the comparison has to fail then.

import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { parseArgs } from "node:util";

import { MeshDecoder, load } from "../crates/meshweft-decoder/decoder.mjs";
import { caseOf, compressedMeshes } from "./compressed_cases.mjs";

const { positionals, values: options } = parseArgs({
    allowPositionals: true,
    options: {
        runner: { type: "string", default: "" },
        decoder: { type: "string" },
        soups: { type: "string", default: "1000" },
        spoil: { type: "string" },
    },
});
const [target, native, build, data] = positionals;

const PARTS = ["code", "order of vertices", "order of faces", "turns of faces", "decoded positions", "decoded faces"];
const [CODE, POSITIONS, FACES] = [0, 4, 5];
/** More differences are counted only. */
const MOST_SHOWN = 10;
/** Bytes that arrive at once. */
const PIECE = 1000;

/** The library on wasm32: gives the answers to all cases. */
async function* answersOfModule(file, cases) {
    const { allocate, release, compressed, answer, memory } = await load(await readFile(file));
    for await (const bytes of cases) {
        const at = allocate(bytes.length);
        Buffer.from(memory.buffer).set(bytes, at);
        const length = compressed(at, bytes.length);
        release(at, bytes.length);
        yield Buffer.from(memory.buffer.slice(answer(), answer() + length));
    }
}

/** The library in a program, the same. */
async function* answersOfProgram([file, ...words], cases) {
    const child = spawn(file, words, { stdio: ["pipe", "pipe", "inherit"] });
    const closed = once(child, "close");
    const written = (async () => {
        for await (const bytes of cases) if (!child.stdin.write(bytes)) await once(child.stdin, "drain");
        child.stdin.end();
    })();
    let rest = Buffer.alloc(0);
    for await (const chunk of child.stdout) {
        rest = Buffer.concat([rest, chunk]);
        while (rest.length >= 4 && rest.length >= 4 + rest.readUInt32LE(0)) {
            const end = 4 + rest.readUInt32LE(0);
            yield rest.subarray(4, end);
            rest = rest.subarray(end);
        }
    }
    await written;
    const [code] = await closed;
    if (code !== 0) throw new Error(`${file} ended with ${code}`);
}

/** The parts of an answer, or the text of its error. */
function parts(answer) {
    if (answer.readUInt32LE(0) !== 0) return answer.subarray(4).toString();
    const found = [];
    for (let at = 4; at < answer.length; ) {
        const end = at + 4 + answer.readUInt32LE(at);
        found.push(answer.subarray(at + 4, end));
        at = end;
    }
    if (found.length !== PARTS.length) throw new Error(`${found.length} parts in an answer`);
    return found;
}

/** Why two answers differ; nothing if they do not. */
function difference(ours, expected) {
    if (typeof ours === "string" || typeof expected === "string") {
        const text = (answer) => (typeof answer === "string" ? answer : "a stream");
        return text(ours) === text(expected) ? undefined : `${text(ours)}; natively ${text(expected)}`;
    }
    const other = PARTS.filter((_, i) => !ours[i].equals(expected[i]));
    return other.length > 0 ? `other ${other.join(", ")}` : undefined;
}

/** What the small decoder makes of a stream, as the bytes of positions and of faces. */
function decoded(exports, code) {
    const decoder = new MeshDecoder(exports);
    const found = [[], []];
    for (let at = 0; at < code.length; at += PIECE) {
        const { positions, faces } = decoder.push(code.subarray(at, at + PIECE));
        for (const [i, some] of [positions, faces].entries()) found[i].push(Buffer.from(some.buffer));
    }
    decoder.finish();
    decoder.free();
    return found.map((some) => Buffer.concat(some));
}

/** All cases, with a name each. */
const tiers = Number(execFileSync(native, ["tiers"]));
async function* all() {
    for await (const mesh of compressedMeshes(Number(options.soups), options.spoil ? undefined : data)) {
        for (let tier = 0; tier < tiers; tier++) {
            for (const bits of [0, 14]) {
                const name = `${mesh.name}, tier ${tier}, ${bits ? `${bits} bits` : "lossless"}`;
                yield { name, bytes: caseOf(mesh, tier, bits) };
            }
        }
    }
}
async function* bytesOfAll() {
    for await (const { bytes } of all()) yield bytes;
}

const start = performance.now();
const other = build.endsWith(".wasm")
    ? answersOfModule(build, bytesOfAll())
    : answersOfProgram([...options.runner.split(" ").filter(Boolean), build], bytesOfAll());
const decoder = options.decoder && (await load(await readFile(options.decoder)));
const answers = [answersOfProgram([native], bytesOfAll()), other];
const counts = { cases: 0, equal: 0, refused: 0, bytes: 0 };
for await (const { name } of all()) {
    // The native program is asked first: it works while the module does.
    const both = await Promise.all(answers.map((side) => side.next()));
    if (both.some(({ done }) => done)) throw new Error("fewer answers than cases");
    const [expected, ours] = both.map(({ value }) => parts(value));
    if (options.spoil === "code" && counts.cases === 0) ours[CODE][0] ^= 1;

    let why = difference(ours, expected);
    if (typeof expected === "string") counts.refused += 1;
    else if (decoder) {
        const [positions, faces] = decoded(decoder, expected[CODE]);
        if (options.spoil === "decoder" && counts.cases === 0) faces[0] ^= 1;
        const isEqual = positions.equals(expected[POSITIONS]) && faces.equals(expected[FACES]);
        if (!isEqual) why = `${why ?? ""} the small decoder gives another mesh`;
    }
    counts.cases += 1;
    counts.equal += !why;
    counts.bytes += typeof expected === "string" ? 0 : expected[CODE].length;
    if (why && counts.cases - counts.equal <= MOST_SHOWN) console.log(`DIFFERENT ${name}: ${why}`);
}
for (const side of answers) {
    if (!(await side.next()).done) throw new Error("more answers than cases");
}
const seconds = ((performance.now() - start) / 1000).toFixed(0);
console.log(
    `${target}: ${counts.cases} meshes compressed in ${tiers} tiers, ${counts.equal} equal to native, ${counts.refused} of` +
        ` them refused, ${counts.bytes} bytes of streams${decoder ? ", decoded by the small decoder too" : ""}; ${seconds} s`,
);
// Equal results say nothing if all are errors.
const isProof = counts.refused * 2 < counts.cases;
process.exitCode = counts.equal === counts.cases && isProof ? 0 : 1;
