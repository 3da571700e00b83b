// Whether three.js draws new meshes: where their sources are drawn, with the same vertices, material
// and skeleton, and so that rays hit their triangles. A ray needs no display, as drawing would.

import { isDeepStrictEqual } from "node:util";

import { parameters, vertexRecords } from "./three.mjs";

const { Raycaster, Triangle, Vector3 } = await import("three");

/** Rays at each new mesh. */
const RAYS = 4;

/** What differs in a file that got new meshes: `told` are their names, faces and sources. */
export function compareDrawn({ name, told, before, after, old, now, tally }) {
    const problems = notAsBefore(old.primitives, now.primitives);
    const { scene } = now.gltf;
    scene.updateMatrixWorld(true);
    const drawn = drawnIn(now.gltf);
    const primitives = numbered(before);
    const oldMeshes = before.meshes?.length ?? 0;
    if ((after.meshes?.length ?? 0) !== oldMeshes + told.length) problems.push("/meshes: not as many as were added");

    told.forEach(([title, faceCount, sourceName], i) => {
        const number = oldMeshes + i;
        const pointer = `/meshes/${number}`;
        const differ = (text) => problems.push(`${pointer} (${title}): ${text}`);
        const mesh = after.meshes[number];
        const loaded = now.primitives[primitives.length + i];
        if (mesh?.name !== title || !loaded) return differ("not there");
        if (loaded.geometry.index?.count !== 3 * Number(faceCount)) differ("the number of faces");
        const instances = drawn.filter((one) => one.mesh === number);

        // A mesh of its own stands at the root.
        if (title === "triangle") {
            if (!isTriangle(loaded.geometry)) differ("other vertices");
            if (instances.length !== 1) return differ(`drawn ${instances.length} times`);
            if (instances[0].part.parent !== scene) differ("not at the root of the default scene");
            return shoot(instances[0].part, `${name} ${title}`, tally, differ);
        }

        // One over shared vertices, like its source.
        const source = sourceOf(mesh, sourceName, loaded, primitives, now);
        if (!source) return differ(`no primitive of ${sourceName} has its vertices and faces`);
        if (mesh.primitives[0].targets) tally.morphed += 1;
        if (isInterleaved(mesh, after)) tally.interleaved += 1;
        if (parameters(loaded.material) !== parameters(source.loaded.material)) differ("another material");
        const node = firstNode(before, source.mesh);
        const original = drawn.find((one) => one.mesh === source.mesh && one.primitive === source.primitive && one.node === node);
        if (!original) {
            tally.undrawn.push(`${name} ${title}`);
            return;
        }
        if (instances.length !== 1) return differ(`drawn ${instances.length} times`);
        const [{ part }] = instances;
        if (parameters(part.material) !== parameters(original.part.material)) differ("drawn with another material");
        if (!isDeepStrictEqual(part.morphTargetInfluences, original.part.morphTargetInfluences)) {
            differ(`morphed by ${part.morphTargetInfluences}, not ${original.part.morphTargetInfluences}`);
        }
        if (part.type !== original.part.type) return differ(`drawn as ${part.type}, not ${original.part.type}`);
        if (part.isSkinnedMesh) {
            tally.skinned += 1;
            if (!isSameSkeleton(part, original.part)) differ("another skeleton");
        } else if (!part.matrixWorld.equals(original.part.matrixWorld)) {
            differ("drawn at another place");
        }
        shoot(part, `${name} ${title}`, tally, differ);
    });
    return problems;
}

/** Old primitives must be loaded as before: bytes, kinds, materials. */
function notAsBefore(old, now) {
    return old.flatMap((one, number) => {
        const other = now[number];
        const isSame =
            other !== undefined &&
            one.kind === other.kind &&
            one.geometry.userData.draco === other.geometry.userData.draco &&
            hasSameVertices(one.geometry, other.geometry) &&
            isDeepStrictEqual(one.geometry.index?.array, other.geometry.index?.array) &&
            parameters(one.material) === parameters(other.material);
        return isSame ? [] : [`three.js: primitive ${number} is not as before`];
    });
}

function hasSameVertices(geometry, other) {
    return geometry === other || isDeepStrictEqual(vertexRecords(geometry), vertexRecords(other));
}

/** All primitives of a file, with the name that a document gives them. */
function numbered({ meshes = [] }) {
    return meshes.flatMap(({ name, primitives }, mesh) =>
        primitives.map((json, primitive) => {
            const title = name ?? `mesh ${mesh}`;
            return { mesh, primitive, json, title: primitives.length > 1 ? `${title}, primitive ${primitive}` : title };
        }),
    );
}

/** The primitive whose vertices are shared: it has the same, and the new faces are every second of its. */
function sourceOf(mesh, title, loaded, primitives, now) {
    const [{ attributes, targets, material }] = mesh.primitives;
    const found = primitives.findIndex(({ json, title: other }, number) => {
        const isLike = isDeepStrictEqual([json.attributes, json.targets, json.material], [attributes, targets, material]);
        if (!isLike || title !== other) return false;
        const { geometry } = now.primitives[number];
        const corners = geometry.index?.array ?? [...Array(geometry.attributes.position.count).keys()];
        const half = Array.from(corners).filter((_, corner) => Math.floor(corner / 3) % 2 === 0);
        const faces = half.slice(0, half.length - (half.length % 3));
        return isDeepStrictEqual(Array.from(loaded.geometry.index.array), faces) && hasSameVertices(geometry, loaded.geometry);
    });
    return found < 0 ? undefined : { ...primitives[found], loaded: now.primitives[found] };
}

/** Everything that the default scene draws, with the numbers it has in the file. */
function drawnIn({ scene, parser }) {
    const drawn = [];
    scene.traverse((part) => {
        if (!part.isMesh && !part.isLine && !part.isPoints) return;
        let holder = part;
        while (holder && parser.associations.get(holder)?.nodes === undefined) holder = holder.parent;
        const { meshes: mesh, primitives: primitive } = parser.associations.get(part) ?? {};
        drawn.push({ part, mesh, primitive: primitive ?? 0, node: parser.associations.get(holder)?.nodes });
    });
    return drawn;
}

/** The node of the smallest number that draws a mesh in the default scene. */
function firstNode({ scene = 0, scenes = [], nodes = [] }, mesh) {
    const shown = new Set();
    const show = (number) => {
        if (shown.has(number)) return;
        shown.add(number);
        (nodes[number].children ?? []).forEach(show);
    };
    (scenes[scene]?.nodes ?? []).forEach(show);
    return [...shown].filter((number) => nodes[number].mesh === mesh).sort((a, b) => a - b)[0];
}

function isInterleaved({ primitives: [{ attributes }] }, { accessors, bufferViews }) {
    const views = Object.values(attributes).map((number) => accessors[number].bufferView);
    return new Set(views).size < views.length && views.some((view) => bufferViews[view]?.byteStride !== undefined);
}

function isSameSkeleton(part, original) {
    const [{ bones, boneInverses }, other] = [part.skeleton, original.skeleton];
    return (
        bones.length === other.bones.length &&
        bones.every((bone, i) => bone === other.bones[i]) &&
        boneInverses.every((matrix, i) => matrix.equals(other.boneInverses[i])) &&
        part.bindMatrix.equals(original.bindMatrix) &&
        part.bindMode === original.bindMode
    );
}

/** The mesh that brings its own vertices, as ../append/src/scene.rs has it. */
function isTriangle({ attributes, index }) {
    const { position, normal, color } = attributes;
    const numbers = (attribute, component) =>
        Array.from({ length: 9 }, (_, i) => component(attribute.getComponent(Math.floor(i / 3), i % 3)));
    return (
        isDeepStrictEqual([...index.array], [0, 1, 2]) &&
        isDeepStrictEqual(numbers(position, (x) => x), [0.5, 0.25, -0.125, 3, 0.5, 0.25, 1, 2, -0.5]) &&
        isDeepStrictEqual(numbers(normal, (x) => x), [0, 0, 1, 0, 1, 0, 0.6, 0, 0.8].map(Math.fround)) &&
        color.normalized &&
        isDeepStrictEqual(numbers(color, (x) => Math.round(255 * x)), [255, 0, 0, 0, 254, 1, 2, 3, 253])
    );
}

/** Sends rays at triangles of a drawn mesh; each must hit that very triangle. */
function shoot(part, title, tally, differ) {
    const { index } = part.geometry;
    const count = index.count / 3;
    const corner = (face, i) => part.getVertexPosition(index.getX(3 * face + i), new Vector3());
    let sent = 0;
    for (let at = 0; at < count && sent < RAYS; at += Math.max(1, Math.floor(count / (16 * RAYS)))) {
        const triangle = new Triangle(corner(at, 0), corner(at, 1), corner(at, 2));
        const size = Math.max(triangle.a.distanceTo(triangle.b), triangle.b.distanceTo(triangle.c), triangle.c.distanceTo(triangle.a));
        // A needle has no side from which it could be hit.
        if (!(triangle.getArea() > 1e-4 * size * size) || part.matrixWorld.determinant() === 0) continue;
        const [middle, normal] = [triangle.getMidpoint(new Vector3()), triangle.getNormal(new Vector3())];
        const origin = middle.clone().addScaledVector(normal, size).applyMatrix4(part.matrixWorld);
        const direction = middle.applyMatrix4(part.matrixWorld).sub(origin).normalize();
        const hits = new Raycaster(origin, direction).intersectObject(part, false);
        sent += 1;
        tally.rays += 1;
        if (hits.some(({ faceIndex }) => faceIndex === at)) tally.hit += 1;
        else differ(`face ${at} is not hit`);
    }
    if (sent === 0) tally.flat.push(title);
}
