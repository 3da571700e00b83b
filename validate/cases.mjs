// What builds for different targets are compared on: meshes, and requests for each of them.

import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { gunzipSync } from "node:zlib";

import { seeded, shuffled } from "./random.mjs";

const TARGETS = ["universal", "fifo:12", "lru:16", "controllable:12", "nvidia", "amd", "batch:20/0/9"];
const EFFORTS = { fast: 0, best: 1, max: 2 };
/** This number of steps stands for no budget. */
const UNLIMITED = 2n ** 64n - 1n;
const BUDGETS = [UNLIMITED, 0n, 1n, 50n];
/** Corners kept: 1; vertices renumbered: 2. */
const FLAGS = [0, 1, 2, 3];
/** On more faces the greatest effort without a budget takes minutes, and is left out. */
const MOST_FACES_WITHOUT_END = 300;

/** A mesh of faces in any order, turned at random, their vertices numbered at random. */
export function shuffledMesh(name, vertexCount, faces, random) {
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

/** Faces of any vertices; some name a vertex twice, some occur twice, some vertices have no face. */
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

/** The triangles and positions of an OFF file. */
export async function off(name, file) {
    const words = gunzipSync(await readFile(file)).toString("latin1").trim().split(/\s+/);
    const [vertexCount, faceCount] = words.slice(1, 3).map(Number);
    const numbers = words.slice(4 + 3 * vertexCount).map(Number);
    const faces = Array.from({ length: faceCount }, (_, i) => numbers.slice(4 * i, 4 * i + 4));
    if (words[0] !== "OFF" || numbers.length !== 4 * faceCount || faces.some(([corners]) => corners !== 3)) {
        throw new Error(`${file}: the triangles are not as expected`);
    }
    const positions = Float32Array.from(words.slice(4, 4 + 3 * vertexCount), Number);
    return { name, vertexCount, positions, indices: faces.flatMap(([, ...face]) => face) };
}

export const SMALLEST = { name: "one face", vertexCount: 3, indices: [2, 0, 1] };

/** Made meshes, and a real one if there is a folder of test data. */
export async function meshes(data) {
    const made = [
        SMALLEST,
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
export function* requests(faceCount) {
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
