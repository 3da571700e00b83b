// Decodes compressed meshes by the module that this crate is built as, in a browser or in Node.
//
//   const exports = await load(fetch("meshweft_decoder.wasm"));
//   const decoder = new MeshDecoder(exports);
//   for await (const bytes of stream) {
//       const { positions, faces } = decoder.push(bytes); // Those that are complete now.
//   }
//   decoder.finish();
//
// A `.mwz` file as a whole: `for (const { name, code } of meshesOf(bytes))`, each code for a decoder of its own.

const INCOMPLETE = 0;
const COMPLETE = 1;
const ERRORS = {
    2: "the stream is damaged. Fetch it again or compress the mesh again",
    3: "the stream is of a kind that is not known. A later version may have written it: update, or fetch it again",
    4: "the stream has more vertices or faces than are allowed. If you trust it, raise the limit",
};
const MOST = 2 ** 32 - 1;

/** The module's exports, from its bytes, or from a response that has them or will have them. */
export async function load(source) {
    const awaited = await source;
    const bytes = typeof awaited.arrayBuffer === "function" ? await awaited.arrayBuffer() : awaited;
    return (await WebAssembly.instantiate(bytes)).instance.exports;
}

/** Decodes a mesh while its bytes arrive. */
export class MeshDecoder {
    #exports;
    #decoder;
    #status = INCOMPLETE;
    #passed = 0;

    /** Refuses a mesh with more vertices or faces. */
    constructor(exports, { vertices = MOST, faces = MOST } = {}) {
        this.#exports = exports;
        this.#decoder = exports.decoder_new(vertices, faces);
    }

    /**
     * Takes the next bytes. Gives what they made complete: `positions`, a Float32Array of three a vertex, `faces`, a
     * Uint32Array of three a face, and how many of the bytes were `used`: all, until the mesh is complete.
     */
    push(bytes) {
        const { memory, ...decoder } = this.#exports;
        const at = decoder.decoder_input(this.#decoder, bytes.length) >>> 0;
        new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
        this.#status = decoder.decoder_push(this.#decoder);
        if (this.#status in ERRORS) {
            throw new Error(`byte ${decoder.decoder_error_byte(this.#decoder) >>> 0}: ${ERRORS[this.#status]}`);
        }
        const used = bytes.length - decoder.decoder_unused(this.#decoder);
        this.#passed += used;
        // Copies: the memory is the module's, and moves when it grows.
        const taken = (Numbers, what) => {
            const first = decoder[`decoder_${what}s`](this.#decoder) >>> 0;
            return new Numbers(memory.buffer, first, 3 * decoder[`decoder_${what}_count`](this.#decoder)).slice();
        };
        return { positions: taken(Float32Array, "position"), faces: taken(Uint32Array, "face"), used };
    }

    /** How many vertices and faces there will be: 0 until that is known. */
    get counts() {
        const { decoder_all_vertices: vertices, decoder_all_faces: faces } = this.#exports;
        return { vertices: vertices(this.#decoder) >>> 0, faces: faces(this.#decoder) >>> 0 };
    }

    get isComplete() {
        return this.#status === COMPLETE;
    }

    /** Throws if the mesh is not complete. */
    finish() {
        if (!this.isComplete) {
            throw new Error(`byte ${this.#passed}: the stream ends before the mesh is complete. Fetch it again`);
        }
    }

    /** Gives the decoder's memory back. Nothing else may be called after this. */
    free() {
        this.#exports.decoder_free(this.#decoder);
    }
}

/** The names and codes of a `.mwz` file. */
export function* meshesOf(bytes) {
    let at = 5;
    if (String.fromCharCode(...bytes.subarray(0, 4)) !== "MWZ\x1a") {
        throw new Error("this is not a .mwz file. Give one that was written by compress");
    }
    if (bytes[4] !== 1) throw new Error(`version ${bytes[4]} of .mwz is not known: update`);
    const cut = (length) => {
        if (length > bytes.length - at) throw new Error(`byte ${at}: the file is cut. Fetch it again`);
    };
    const number = () => {
        let value = 0;
        for (let weight = 1; ; weight *= 128) {
            cut(1);
            const byte = bytes[at++];
            value += (byte & 127) * weight;
            if (byte < 128) return value;
        }
    };

    const count = number();
    for (let mesh = 0; mesh < count; mesh++) {
        const begin = at;
        const [nameLength, codeLength] = [number(), number()];
        cut(nameLength + codeLength + 4);
        const name = new TextDecoder().decode(bytes.subarray(at, at + nameLength));
        const code = bytes.subarray(at + nameLength, at + nameLength + codeLength);
        at += nameLength + codeLength;
        const said = new DataView(bytes.buffer, bytes.byteOffset + at, 4).getUint32(0, true);
        if (crc32(bytes.subarray(begin, at)) !== said) throw new Error(`byte ${begin}: mesh ${mesh} is damaged`);
        at += 4;
        yield { name, code };
    }
    if (at !== bytes.length) throw new Error(`byte ${at}: bytes follow the last mesh. The file is damaged`);
}

/** As in PNG and gzip. */
function crc32(bytes) {
    let sum = -1;
    for (const byte of bytes) {
        sum ^= byte;
        for (let bit = 0; bit < 8; bit++) sum = (sum >>> 1) ^ (0xedb88320 & -(sum & 1));
    }
    return ~sum >>> 0;
}
