// Runs the library on wasm32 and natively, on the same indices and requests: status, misses and
// indices must be equal, byte for byte, and nothing may trap. The module may import nothing, so there
// is no clock in it.
//
// Usage: node wasm.mjs MODULE.wasm NATIVE [--spoil index|panic] [DATA_FOLDER]
//
// `--spoil` changes one index of one result, or lets one call panic, on the smallest mesh alone: the
// comparison has to fail then.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { gunzipSync } from "node:zlib";

import { seeded, shuffled } from "./random.mjs";

const { positionals, values: options } = parseArgs({
    allowPositionals: true,
    options: { spoil: { type: "string" } },
});
const [module, native, data] = positionals;

const TARGETS = ["universal", "fifo:12", "lru:16", "controllable:12", "nvidia", "amd", "batch:20/0/9"];
const EFFORTS = { fast: 0, best: 1, max: 2 };
/** As many steps mean that there is no budget. */
const UNLIMITED = 2n ** 64n - 1n;
const BUDGETS = [UNLIMITED, 0n, 1n, 50n];
/** Corners kept: 1; vertices renumbered: 2. */
const FLAGS = [0, 1, 2, 3];
const WIDTHS = [Uint16Array, Uint32Array];
const NO_SUCH_EFFORT = 9;
/** A mesh with more faces is not ordered with the greatest effort and no budget: that takes minutes. */
const MOST_FACES_WITHOUT_END = 300;
/** More differences are counted only. */
const MOST_SHOWN = 10;

/** Faces in any order, turned at random, their vertices numbered at random. */
function shuffledMesh(name, vertexCount, faces, random) {
    const numbers = shuffled(Array(vertexCount).keys(), random);
    const turned = faces.map((face) => {
        const turn = Math.floor(3 * random());
        return [...face.slice(turn), ...face.slice(0, turn)].map((vertex) => numbers[vertex]);
    });
    return { name, vertexCount, indices: shuffled(turned, random).flat() };
}

function grid(name, side) {
    const row = side + 1;
    const faces = [];
    for (let y = 0; y < side; y++) {
        for (let x = 0; x < side; x++) {
            const at = y * row + x;
            faces.push([at, at + 1, at + row + 1], [at, at + row + 1, at + row]);
        }
    }
    return shuffledMesh(name, row * row, faces, seeded(side));
}

/** A closed surface whose vertices have any number of faces. */
function torus(name, rings, sides) {
    const random = seeded(rings);
    const vertex = (ring, side) => (ring % rings) * sides + (side % sides);
    const faces = [];
    for (let ring = 0; ring < rings; ring++) {
        for (let side = 0; side < sides; side++) {
            const [a, b] = [vertex(ring, side), vertex(ring + 1, side)];
            const [c, d] = [vertex(ring + 1, side + 1), vertex(ring, side + 1)];
            if (random() < 0.5) faces.push([a, b, c], [a, c, d]);
            else faces.push([a, b, d], [b, c, d]);
        }
    }
    return shuffledMesh(name, rings * sides, faces, random);
}

/** Faces of any vertices; some name a vertex twice or are there twice, some vertices have no face. */
function soup(name, faceCount, vertexCount) {
    const random = seeded(faceCount);
    const any = () => Math.floor(vertexCount * random());
    const faces = [];
    while (faces.length < faceCount) {
        const face = [any(), any(), any()];
        const kind = random();
        if (kind < 0.1) face[2] = face[0];
        else if (kind < 0.12) face.fill(face[0]);
        else if (kind < 0.2) faces.push(face);
        faces.push(face);
    }
    return { name, vertexCount, indices: faces.flat() };
}

/** The triangles of an OFF file. */
async function off(name, file) {
    const words = gunzipSync(await readFile(file)).toString("latin1").trim().split(/\s+/);
    const [vertexCount, faceCount] = words.slice(1, 3).map(Number);
    const numbers = words.slice(4 + 3 * vertexCount).map(Number);
    const faces = Array.from({ length: faceCount }, (_, i) => numbers.slice(4 * i, 4 * i + 4));
    if (words[0] !== "OFF" || numbers.length !== 4 * faceCount || faces.some(([corners]) => corners !== 3)) {
        throw new Error(`${file}: not the triangles that were expected`);
    }
    return { name, vertexCount, indices: faces.flatMap(([, ...face]) => face) };
}

async function meshes() {
    const one = { name: "one face", vertexCount: 3, indices: [2, 0, 1] };
    if (options.spoil) return [one];
    const made = [
        one,
        { name: "no faces", vertexCount: 5, indices: [] },
        { name: "an index too large", vertexCount: 3, indices: [0, 1, 2, 1, 2, 3] },
        { name: "half a face", vertexCount: 3, indices: [0, 1, 2, 1] },
        grid("small grid", 9),
        soup("soup", 120, 60),
        torus("torus", 32, 16),
        grid("grid", 50),
    ];
    if (data) made.push(await off("fandisk", join(data, "meshes", "fandisk.off.gz")));
    return made;
}

/** Every combination, with another seed each. */
function* requests(faceCount) {
    const random = seeded(faceCount);
    const word = () => BigInt(Math.floor(2 ** 32 * random()));
    for (const target of TARGETS) {
        for (const [effort, number] of Object.entries(EFFORTS)) {
            for (const steps of BUDGETS) {
                if (effort === "max" && steps === UNLIMITED && faceCount > MOST_FACES_WITHOUT_END) continue;
                for (const flags of FLAGS) {
                    const seed = (word() << 32n) | word();
                    // The misses are counted in one cache.
                    const cache = target === "universal" ? "intel" : target;
                    yield { target, effort: number, steps, seed, flags, cache };
                }
            }
        }
    }
}

/** The library on wasm32. */
class Library {
    static async load(file) {
        const module = await WebAssembly.compile(await readFile(file));
        const imports = WebAssembly.Module.imports(module);
        if (imports.length > 0) throw new Error(`${file} imports ${imports.map(({ name }) => name).join(", ")}`);
        return new Library(module);
    }

    constructor(module) {
        this.module = module;
        this.start();
    }

    start() {
        this.exports = new WebAssembly.Instance(this.module).exports;
        this.exports.keep_panics();
    }

    /** The answer to a request, as the native program writes it. */
    answer(indices, vertexCount, request) {
        try {
            return this.#answer(indices, vertexCount, request);
        } catch (error) {
            if (!(error instanceof WebAssembly.RuntimeError)) throw error;
            const { panic_text, panic_text_bytes } = this.exports;
            const text = this.#bytes(panic_text(), panic_text_bytes()).toString();
            // What trapped is not whole.
            this.start();
            return new Error(`trap: ${error.message}; ${text || "no panic"}`);
        }
    }

    #answer(indices, vertexCount, { target, effort, steps, seed, flags, cache }) {
        const optimize = indices.BYTES_PER_ELEMENT === 2 ? this.exports.optimize_u16 : this.exports.optimize_u32;
        const { length } = indices;
        const ordered = indices.slice();
        const status = this.#with(ordered, (at) =>
            this.#with(Buffer.from(target), (name, bytes) =>
                optimize(at, length, vertexCount, name, bytes, effort, steps, seed, flags),
            ),
        );
        const misses = this.#with(Uint32Array.from(ordered), (at) =>
            this.#with(Buffer.from(cache), (name, bytes) =>
                this.exports.misses(at, length, vertexCount, name, bytes),
            ),
        );
        const head = Buffer.alloc(12);
        head.writeUInt32LE(status >>> 0, 0);
        head.writeBigUInt64LE(BigInt.asUintN(64, misses), 4);
        return Buffer.concat([head, bytesOf(ordered)]);
    }

    /** Calls with the array's place in the memory of the module, and copies back what is there then. */
    #with(array, call) {
        const bytes = bytesOf(array);
        const at = this.exports.allocate(bytes.length);
        // The memory may grow, and its old view is empty then: each time a new one.
        this.#bytes(at, bytes.length).set(bytes);
        const result = call(at, bytes.length);
        bytes.set(this.#bytes(at, bytes.length));
        this.exports.release(at, bytes.length);
        return result;
    }

    #bytes(at, length) {
        return Buffer.from(this.exports.memory.buffer, at, length);
    }
}

function bytesOf(array) {
    return Buffer.from(array.buffer, array.byteOffset, array.byteLength);
}

/** The native program with all requests for one mesh: its answers, one after the other. */
async function* nativeAnswers(indices, vertexCount, all) {
    const numbers = [8 * indices.BYTES_PER_ELEMENT, indices.length, vertexCount];
    const child = spawn(native, numbers.map(String), { stdio: ["pipe", "pipe", "inherit"] });
    const closed = once(child, "close");
    const lines = all.map((request) => `${Object.values(request).join(" ")}\n`);
    child.stdin.end(Buffer.concat([bytesOf(indices), Buffer.from(lines.join(""))]));

    const size = 12 + indices.byteLength;
    let rest = Buffer.alloc(0);
    for await (const chunk of child.stdout) {
        rest = Buffer.concat([rest, chunk]);
        for (; rest.length >= size; rest = rest.subarray(size)) yield rest.subarray(0, size);
    }
    const [code] = await closed;
    if (code !== 0) throw new Error(`${native} ended with ${code}`);
}

/** Why two answers differ; nothing if they do not. */
function difference(ours, expected) {
    if (ours instanceof Error) return ours.message;
    const [a, b] = [ours, expected].map((answer) => [answer.readUInt32LE(0), answer.readBigUInt64LE(4)]);
    if (a[0] !== b[0]) return `status ${a[0]}, natively ${b[0]}`;
    if (a[1] !== b[1]) return `${a[1]} misses, natively ${b[1]}`;
    if (!ours.equals(expected)) return "the indices differ";
}

const start = performance.now();
const library = await Library.load(module);
const counts = { cases: 0, equal: 0, changed: 0 };
for (const { name, vertexCount, indices } of await meshes()) {
    for (const Width of WIDTHS) {
        const original = Width.from(indices);
        const all = [...requests(Math.ceil(indices.length / 3))];
        const answers = nativeAnswers(original, vertexCount, all);
        for (const request of all) {
            const isSpoilt = options.spoil && counts.cases === 0;
            const asked = isSpoilt && options.spoil === "panic" ? { ...request, effort: NO_SUCH_EFFORT } : request;
            // The native program works meanwhile.
            const next = answers.next();
            const ours = library.answer(original, vertexCount, asked);
            if (isSpoilt && options.spoil === "index") ours[12] ^= 1;
            const { value: expected, done } = await next;
            if (done) throw new Error(`${native} gave fewer answers than it was asked for`);

            const why = difference(ours, expected);
            counts.cases += 1;
            counts.equal += !why;
            counts.changed += !bytesOf(original).equals(expected.subarray(12));
            if (why && counts.cases - counts.equal <= MOST_SHOWN) {
                const words = Object.values(request).join(" ");
                console.log(`DIFFERENT ${name}, ${8 * original.BYTES_PER_ELEMENT} bits, ${words}: ${why}`);
            }
        }
        if (!(await answers.next()).done) throw new Error(`${native} gave more answers than it was asked for`);
    }
}
const seconds = ((performance.now() - start) / 1000).toFixed(0);
console.log(
    `wasm32: ${counts.cases} cases, ${counts.equal} equal to native, ${counts.changed} of them with` +
        ` another order than they came in; ${seconds} s`,
);
// Equal results say nothing if no order was made.
const isProof = counts.changed > 0 || options.spoil;
process.exitCode = counts.equal === counts.cases && isProof ? 0 : 1;
