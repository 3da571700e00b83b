// A plain reading of GLB: the JSON chunk, and accessors as numbers. It shares nothing with the
// tools that it judges.

const ARRAYS = {
    5120: Int8Array,
    5121: Uint8Array,
    5122: Int16Array,
    5123: Uint16Array,
    5125: Uint32Array,
    5126: Float32Array,
};
const LARGEST = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };
const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };

export class Glb {
    constructor(bytes) {
        const length = bytes.readUInt32LE(12);
        this.jsonBytes = bytes.subarray(20, 20 + length);
        this.json = JSON.parse(this.jsonBytes.toString());
        const binary = bytes.subarray(20 + length + 8);
        this.buffers = (this.json.buffers ?? []).map(({ uri }) =>
            uri === undefined ? binary : Buffer.from(uri.slice(uri.indexOf(",") + 1), "base64"),
        );
    }

    #numbers(view, offset, componentType, width, count) {
        const { buffer, byteOffset = 0, byteStride } = this.json.bufferViews[view];
        const size = ARRAYS[componentType].BYTES_PER_ELEMENT;
        const start = byteOffset + offset;
        const stride = byteStride ?? width * size;
        return Array.from({ length: count }, (_, i) => {
            const at = start + i * stride;
            const bytes = Uint8Array.prototype.slice.call(this.buffers[buffer], at, at + width * size);
            return [...new ARRAYS[componentType](bytes.buffer, 0, width)];
        });
    }

    /** The elements of an accessor, each an array of numbers, normalized ones as fractions. */
    elements(number) {
        const accessor = this.json.accessors[number];
        const { bufferView, byteOffset = 0, componentType, type, count, normalized, sparse } = accessor;
        const width = COMPONENTS[type];
        const elements =
            bufferView === undefined
                ? Array.from({ length: count }, () => Array(width).fill(0))
                : this.#numbers(bufferView, byteOffset, componentType, width, count);
        if (sparse) {
            const { indices, values } = sparse;
            const read = ({ bufferView, byteOffset = 0 }, type, columns) =>
                this.#numbers(bufferView, byteOffset, type, columns, sparse.count);
            const places = read(indices, indices.componentType, 1);
            const given = read(values, componentType, width);
            places.forEach(([place], i) => (elements[place] = given[i]));
        }
        return normalized ? elements.map((element) => element.map((x) => x / LARGEST[componentType])) : elements;
    }

    primitives() {
        return (this.json.meshes ?? []).flatMap(({ primitives }) => primitives);
    }
}
