// Meshes that builds for different targets compress.

import { join } from "node:path";

import { off, shuffledMesh } from "./cases.mjs";
import { seeded } from "./random.mjs";

/** Surfaces that are closed, have borders, or are of several parts. */
const FILES = ["fandisk", "horse_20k", "elephant_holes", "casting", "hornbug"];

/** Faces of any kind: a piece of a grid or a torus with holes, faces flipped, repeated, and of any vertices. */
function soup(number) {
    const random = seeded(number);
    const below = (count) => Math.floor(count * random());
    const [width, height, isClosed] = [3 + below(9), 3 + below(9), random() < 0.5];
    const vertex = (x, y) => (y % height) * width + (x % width);
    const faces = [];
    for (let y = 0; y < height - !isClosed; y++) {
        for (let x = 0; x < width - !isClosed; x++) {
            const [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
            faces.push([a, b, c], [a, c, d]);
        }
    }
    const vertexCount = width * height + below(4);
    for (let left = below(3) && below(30); left > 0; left--) {
        const [a, b, c] = faces[below(faces.length)];
        const any = below(vertexCount);
        const made = [[a, c, b], [a, b, c], [b, a, any], [a, a, any], [any, below(vertexCount), below(vertexCount)]];
        if (random() < 0.3) faces.splice(below(faces.length), 1);
        faces.push(made[below(made.length)]);
    }
    return { positions: positions(vertexCount, random), ...shuffledMesh(`soup ${number}`, vertexCount, faces, random) };
}

/** Small multiples of a step, and in one of eight meshes any bits. */
function positions(vertexCount, random) {
    const isWild = random() < 0.125;
    const bits = Uint32Array.from({ length: 3 * vertexCount }, () => Math.floor(2 ** 32 * random()));
    // Never through a number: its bits might change.
    return isWild ? new Float32Array(bits.buffer) : Float32Array.from(bits, (it) => (it % 4001) / 64 - 30);
}

/** Some soups, and real meshes if there is a folder of test data. */
export async function* compressedMeshes(soups, data) {
    for (let number = 0; number < soups; number++) yield soup(number);
    for (const name of data ? FILES : []) yield await off(name, join(data, "meshes", `${name}.off.gz`));
}

/** A mesh for one tier and 14 bits, or none: lossless. */
export function caseOf({ vertexCount, positions, indices }, tier, bits) {
    const firstVertex = (7 * tier + bits) % vertexCount;
    const head = Uint32Array.of(vertexCount, indices.length / 3, tier, bits, firstVertex);
    const parts = [head, positions, Uint32Array.from(indices)];
    return Buffer.concat(parts.map((it) => Buffer.from(it.buffer, it.byteOffset, it.byteLength)));
}
