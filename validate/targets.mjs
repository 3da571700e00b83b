// Runs the library as built for another target and natively, on the same indices and requests: status,
// misses and indices must be equal, byte for byte, and nothing may trap.
//
// Usage: node targets.mjs NAME NATIVE BUILD [--runner COMMAND] [--every N] [--spoil index|panic] [DATA_FOLDER]
//
// BUILD is a module of WebAssembly (`.wasm`), which may import nothing, so that there is no clock in it;
// or else the program that NATIVE is, built for another processor, for COMMAND to run. NAME is the
// target's name in the last line. With `--every`, only every Nth request is made.
//
// `--spoil` changes one index of one result, or lets one call panic, on the smallest mesh alone: the
// comparison has to fail then.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFile } from "node:fs/promises";
import { parseArgs } from "node:util";

import { SMALLEST, meshes, requests } from "./cases.mjs";

const { positionals, values: options } = parseArgs({
    allowPositionals: true,
    options: {
        runner: { type: "string", default: "" },
        every: { type: "string", default: "1" },
        spoil: { type: "string" },
    },
});
const [target, native, build, data] = positionals;
const every = Number(options.every);

const NO_SUCH_EFFORT = 9;
/** More differences are counted only. */
const MOST_SHOWN = 10;

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

    /** The answers to all requests, one after the other. */
    async *answers(indices, vertexCount, all) {
        for (const request of all) yield this.#answerOrTrap(indices, vertexCount, request);
    }

    /** The answer to a request, as a program writes it. */
    #answerOrTrap(indices, vertexCount, request) {
        try {
            return this.#answer(indices, vertexCount, request);
        } catch (error) {
            if (!(error instanceof WebAssembly.RuntimeError)) throw error;
            const { panic_text, panic_text_bytes } = this.exports;
            const text = this.#bytes(panic_text(), panic_text_bytes()).toString();
            // After a trap the instance cannot be used.
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

    /** Copies the array into the module's memory, calls with its address, and copies it back. */
    #with(array, call) {
        const bytes = bytesOf(array);
        const at = this.exports.allocate(bytes.length);
        // Memory that grows leaves old views empty: a new one each time.
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

/** The library in a program that answers requests. */
class Program {
    constructor(command) {
        this.command = command;
    }

    /** The answers to all requests, one after the other. */
    async *answers(indices, vertexCount, all) {
        const [file, ...words] = this.command;
        const numbers = [8 * indices.BYTES_PER_ELEMENT, indices.length, vertexCount].map(String);
        const child = spawn(file, [...words, ...numbers], { stdio: ["pipe", "pipe", "inherit"] });
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
        if (code !== 0) throw new Error(`${this.command.join(" ")} ended with ${code}`);
    }
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
const other = build.endsWith(".wasm")
    ? await Library.load(build)
    : new Program([...options.runner.split(" ").filter(Boolean), build]);
const sides = [new Program([native]), other];
const counts = { cases: 0, equal: 0, changed: 0 };
for (const { name, vertexCount, indices } of options.spoil ? [SMALLEST] : await meshes(data)) {
    for (const Width of [Uint16Array, Uint32Array]) {
        const original = Width.from(indices);
        const all = [...requests(Math.ceil(indices.length / 3))].filter((_, i) => i % every === 0);
        const isSpoilt = options.spoil && counts.cases === 0;
        const asked = [...all];
        if (isSpoilt && options.spoil === "panic") asked[0] = { ...all[0], effort: NO_SUCH_EFFORT };
        const [expectedAnswers, ourAnswers] = [
            sides[0].answers(original, vertexCount, all),
            sides[1].answers(original, vertexCount, asked),
        ];
        for (const request of all) {
            // The native program is asked first: it works while the module does.
            const answers = await Promise.all([expectedAnswers.next(), ourAnswers.next()]);
            if (answers.some(({ done }) => done)) throw new Error("fewer answers than requests");
            const [expected, ours] = answers.map(({ value }) => value);
            if (isSpoilt && options.spoil === "index" && request === all[0]) ours[12] ^= 1;

            const why = difference(ours, expected);
            counts.cases += 1;
            counts.equal += !why;
            counts.changed += !bytesOf(original).equals(expected.subarray(12));
            if (why && counts.cases - counts.equal <= MOST_SHOWN) {
                const words = Object.values(request).join(" ");
                console.log(`DIFFERENT ${name}, ${8 * original.BYTES_PER_ELEMENT} bits, ${words}: ${why}`);
            }
        }
        for (const answers of [expectedAnswers, ourAnswers]) {
            if (!(await answers.next()).done) throw new Error("more answers than requests");
        }
    }
}
const seconds = ((performance.now() - start) / 1000).toFixed(0);
console.log(
    `${target}: ${counts.cases} cases, ${counts.equal} equal to native, ${counts.changed} of them with` +
        ` another order than they came in${every > 1 ? `; 1 of ${every} requests` : ""}; ${seconds} s`,
);
// Equal results say nothing if no order was made.
const isProof = counts.changed > 0 || options.spoil;
process.exitCode = counts.equal === counts.cases && isProof ? 0 : 1;
