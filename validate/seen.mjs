// A GLB of transparent surfaces whose faces are sorted for the camera of `pictures.mjs`: drawn in another
// order, they look different. Beside them an opaque grid, which may be re-ordered.

import { seeded, shuffled } from "./random.mjs";

/** Where the camera is, looking along -z. */
export const EYE = [0, 0, 6];

const FLOAT = 5126;
const UNSIGNED_BYTE = 5121;
const UNSIGNED_SHORT = 5123;
const SIZES = { [FLOAT]: 4, [UNSIGNED_BYTE]: 1, [UNSIGNED_SHORT]: 2 };
const TYPES = ["", "SCALAR", "VEC2", "VEC3", "VEC4"];

/** Faces of a grid of `columns` by `rows` quads over numbered places. */
function quads(columns, rows, number) {
    const faces = [];
    for (let y = 0; y < rows; y++) {
        for (let x = 0; x < columns; x++) {
            const [a, b, c, d] = [number(x, y), number(x + 1, y), number(x + 1, y + 1), number(x, y + 1)];
            faces.push([a, b, c], [a, c, d]);
        }
    }
    return faces;
}

/** A closed shell around a point. */
function shell([cx, cy, cz], radius, columns, rows) {
    const positions = [];
    for (let y = 0; y <= rows; y++) {
        for (let x = 0; x < columns; x++) {
            const [around, down] = [(2 * Math.PI * x) / columns, (Math.PI * y) / rows];
            positions.push([
                cx + radius * Math.sin(down) * Math.cos(around),
                cy + radius * Math.cos(down),
                cz + radius * Math.sin(down) * Math.sin(around),
            ]);
        }
    }
    return { positions, faces: quads(columns, rows, (x, y) => y * columns + (x % columns)) };
}

/** A sheet with waves along x and y. */
function sheet([cx, cy, cz], width, quadsAlong, height) {
    const positions = [];
    for (let y = 0; y <= quadsAlong; y++) {
        for (let x = 0; x <= quadsAlong; x++) {
            const [u, v] = [x / quadsAlong - 0.5, y / quadsAlong - 0.5];
            positions.push([cx + u * width, cy + v * width, cz + height * Math.sin(19 * u) * Math.cos(13 * v)]);
        }
    }
    return { positions, faces: quads(quadsAlong, quadsAlong, (x, y) => y * (quadsAlong + 1) + x) };
}

/** Several pieces as one. */
function joined(pieces) {
    const positions = [];
    const faces = [];
    for (const piece of pieces) {
        faces.push(...piece.faces.map((face) => face.map((vertex) => vertex + positions.length)));
        positions.push(...piece.positions);
    }
    return { positions, faces };
}

/** The faces from the farthest to the nearest. */
function sorted({ positions, faces }) {
    const distance = (face) =>
        [0, 1, 2].reduce((sum, axis) => {
            const middle = face.reduce((total, vertex) => total + positions[vertex][axis], 0) / 3;
            return sum + (middle - EYE[axis]) ** 2;
        }, 0);
    const order = faces.map((face) => [distance(face), face]).sort(([a], [b]) => b - a);
    return { positions, faces: order.map(([, face]) => face) };
}

function mixed({ positions, faces }, random) {
    return { positions, faces: shuffled(faces, random) };
}

/** The GLB, always the same bytes. */
export function seen() {
    const random = seeded(5);
    const chunks = [];
    let length = 0;
    const [accessors, bufferViews] = [[], []];
    const add = (elements, componentType, more = {}) => {
        const size = SIZES[componentType];
        const bytes = Buffer.alloc(Math.ceil((elements.length * elements[0].length * size) / 4) * 4);
        elements.flat().forEach((value, i) => {
            if (componentType === FLOAT) bytes.writeFloatLE(value, i * size);
            else bytes.writeUIntLE(value, i * size, size);
        });
        bufferViews.push({ buffer: 0, byteOffset: length, byteLength: elements.length * elements[0].length * size });
        chunks.push(bytes);
        length += bytes.length;
        accessors.push({
            bufferView: bufferViews.length - 1,
            componentType,
            count: elements.length,
            type: TYPES[elements[0].length],
            ...more,
        });
        return accessors.length - 1;
    };
    const primitive = ({ positions, faces }, material, componentType, more = {}) => {
        const bounds = (best) => [0, 1, 2].map((axis) => Math.fround(best(...positions.map((p) => p[axis]))));
        const most = componentType === FLOAT ? 1 : 255;
        const whole = (part) => (componentType === FLOAT ? part : Math.round(part * most));
        const colours = positions.map(() => [random(), random(), random(), 0.2 + 0.6 * random()].map(whole));
        return {
            attributes: {
                POSITION: add(positions, FLOAT, { min: bounds(Math.min), max: bounds(Math.max) }),
                COLOR_0: add(colours, componentType, componentType === FLOAT ? {} : { normalized: true }),
            },
            indices: add(faces.flat().map((vertex) => [vertex]), UNSIGNED_SHORT),
            material,
            ...more,
        };
    };

    // Shells inside and beside each other, in one primitive; crossing sheets; one that is transparent in a
    // variant alone; an opaque one at the back.
    const shells = [0, 1, 2, 3, 4].map((i) => shell([-1.6 + 0.25 * i, 0.6 - 0.2 * i, 0.1 * i], 0.9 - 0.12 * i, 24, 16));
    const sheets = [sheet([1.4, 0.8, 0], 1.8, 24, 0.3), sheet([1.5, 0.7, 0.05], 1.8, 22, -0.3)];
    const variant = [shell([0.9, -1.3, 0], 0.8, 24, 16), shell([1.2, -1.2, 0.1], 0.6, 20, 12)];
    const mappings = [{ material: 1, variants: [0] }];
    const primitives = [
        primitive(sorted(joined(shells)), 0, FLOAT),
        primitive(sorted(joined(sheets)), 1, UNSIGNED_BYTE),
        primitive(sorted(joined(variant)), 2, FLOAT, { extensions: { KHR_materials_variants: { mappings } } }),
        primitive(mixed(sheet([0, 0, -1.5], 5, 30, 0.1), random), 2, FLOAT),
    ];
    const material = (name, more) => ({ name, doubleSided: true, extensions: { KHR_materials_unlit: {} }, ...more });
    const json = {
        asset: { version: "2.0" },
        extensionsUsed: ["KHR_materials_unlit", "KHR_materials_variants"],
        extensions: { KHR_materials_variants: { variants: [{ name: "glass" }] } },
        scene: 0,
        scenes: [{ nodes: primitives.map((_, node) => node) }],
        nodes: primitives.map((_, mesh) => ({ mesh })),
        meshes: primitives.map((one) => ({ primitives: [one] })),
        materials: [
            { name: "lit glass", doubleSided: true, alphaMode: "BLEND", pbrMetallicRoughness: { metallicFactor: 0 } },
            material("glass", { alphaMode: "BLEND" }),
            material("solid", {}),
        ],
        accessors,
        bufferViews,
        buffers: [{ byteLength: length }],
    };
    const text = Buffer.from(JSON.stringify(json));
    const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
    const head = Buffer.alloc(20);
    head.write("glTF");
    head.writeUInt32LE(2, 4);
    head.writeUInt32LE(28 + padded.length + length, 8);
    head.writeUInt32LE(padded.length, 12);
    head.write("JSON", 16);
    const binary = Buffer.alloc(8);
    binary.writeUInt32LE(length, 0);
    binary.write("BIN\0", 4);
    return Buffer.concat([head, padded, binary, ...chunks]);
}
