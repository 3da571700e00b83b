// Transparent surfaces look the same after `meshweft optimize`: three.js draws each scene in headless
// Chromium, with its software rasteriser, before and after, and not a pixel may differ.
//
// Usage: node pictures.mjs MESHWEFT DATA_FOLDER [FOLDER_FOR_PICTURES]
//
// That the pictures can tell is made sure of: ordered with --reorder-transparent, the made scene must look different.

import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";

import { openPage } from "./browser.mjs";
import { copyAround, isChanged } from "./reading.mjs";
import { EYE, seen } from "./seen.mjs";

const [program, data, pictures] = process.argv.slice(2);
const run = promisify(execFile);
const SIZE = 384;

const SCRIPT = `
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
renderer.setSize(${SIZE}, ${SIZE}, false);
document.body.append(renderer.domElement);

async function withVariant(gltf, variant) {
    const parts = [];
    gltf.scene.traverse((part) => parts.push(part));
    for (const part of parts) {
        const mappings = part.userData.gltfExtensions?.KHR_materials_variants?.mappings ?? [];
        const mapping = mappings.find(({ variants }) => variants.includes(variant));
        if (!mapping) continue;
        part.material = await gltf.parser.getDependency("material", mapping.material);
        gltf.parser.assignFinalMaterial(part);
    }
}

// Without normals there is no light: the colours alone, of both sides at once. (three.js would draw the far
// sides first and the near ones after them, which most engines do not.)
function lightless(scene) {
    scene.traverse((part) => {
        if (!part.isMesh || part.geometry.attributes.normal) return;
        const { transparent, opacity, depthWrite, vertexColors } = part.material;
        const plain = { transparent, opacity, depthWrite, vertexColors };
        part.material = new THREE.MeshBasicMaterial({ ...plain, side: THREE.DoubleSide, forceSinglePass: true });
    });
}

// The pixels of one view, as text: "eye" from where the made scene is sorted for, or a direction.
window.draw = async (uri, view, variant, isOpaqueAlone) => {
    const gltf = await new GLTFLoader().loadAsync(uri);
    if (variant !== undefined && variant !== null) await withVariant(gltf, variant);
    lightless(gltf.scene);
    if (isOpaqueAlone) gltf.scene.traverse((part) => (part.visible = !part.material?.transparent));
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0x808080);
    scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x404040, 3));
    const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
    if (view === "eye") camera.position.set(${EYE.join()});
    else {
        const ball = new THREE.Box3().setFromObject(gltf.scene).getBoundingSphere(new THREE.Sphere());
        camera.near = ball.radius / 10;
        camera.far = ball.radius * 10;
        camera.position.fromArray(view).setLength(ball.radius * 2.8).add(ball.center);
        camera.lookAt(ball.center);
        camera.updateProjectionMatrix();
    }
    renderer.render(scene, camera);
    const gl = renderer.getContext();
    const pixels = new Uint8Array(4 * ${SIZE} * ${SIZE});
    gl.readPixels(0, 0, ${SIZE}, ${SIZE}, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let text = "";
    for (const byte of pixels) text += String.fromCharCode(byte);
    return btoa(text);
};
`;

/** Where two pictures differ, and by how much at most. */
function different(a, b) {
    const places = [];
    let most = 0;
    for (let at = 0; at < a.length; at += 4) {
        const by = Math.max(...[0, 1, 2, 3].map((part) => Math.abs(a[at + part] - b[at + part])));
        if (by > 0) places.push(at);
        most = Math.max(most, by);
    }
    return { places, most };
}

/** How many pixels of a picture are not those of its first corner: an empty one shows nothing. */
function drawn(pixels) {
    const empty = pixels.readUInt32LE(0);
    let count = 0;
    for (let at = 0; at < pixels.length; at += 4) count += pixels.readUInt32LE(at) !== empty;
    return count;
}

/**
 * Where the opaque faces alone give other pictures: two that are at the same depth, of which the first or the
 * last is seen. That is so in any order, and no fault of this one.
 */
async function opaqueTies(picture, before, after, view, variant) {
    const [old, made] = [await picture(`/${before}`, view, variant, true), await picture(`/${after}`, view, variant, true)];
    return new Set(different(old, made).places);
}

const scratch = await mkdtemp(join(tmpdir(), "meshweft-pictures-"));
const faults = [];
const { page, close } = await openPage(SCRIPT, scratch, faults);
let failed = 0;
try {
    const picture = async (uri, view, variant, isOpaqueAlone = false) => {
        const text = await page.evaluate(([...all]) => window.draw(...all), [uri, view, variant, isOpaqueAlone]);
        if (pictures && !isOpaqueAlone) {
            await mkdir(pictures, { recursive: true });
            const name = `${uri.slice(1).replaceAll("/", "-")}-${[view].flat().join("_")}-${variant ?? ""}.png`;
            await page.locator("canvas").screenshot({ path: join(pictures, name) });
        }
        return Buffer.from(text, "base64");
    };

    await writeFile(join(scratch, "seen.glb"), seen());
    await writeFile(join(scratch, "alpha-blend.glb"), await readFile(join(data, "reports", "alpha-blend.glb")));
    await copyAround(join(data, "gltf", "FlightHelmet", "FlightHelmet.gltf"), join(scratch, "helmet"));
    for (const name of ["FlightHelmet.gltf", "FlightHelmet.bin"]) {
        await writeFile(join(scratch, "helmet", name), await readFile(join(data, "gltf", "FlightHelmet", name)));
    }

    const around = [[0, 0, 1], [1, 0.3, 0.4], [-0.6, 0.5, -1]];
    const cases = [
        ["seen.glb", ["eye", ...around], [undefined, 0]],
        ["alpha-blend.glb", [...around, [0, 0, -1]], [undefined]],
        ["helmet/FlightHelmet.gltf", around, [undefined]],
    ];
    for (const [name, views, variants] of cases) {
        for (const flags of [[], ["--effort", "best"], ["--cache", "fifo:16"]]) {
            const title = `pictures: ${name}, ${flags.join(" ") || "default flags"}`;
            const after = join("after", name);
            await rm(join(scratch, "after"), { recursive: true, force: true });
            await run(program, ["optimize", join(scratch, name), "-o", join(scratch, after), "--quiet", ...flags]);
            const isMoved = await isChanged(join(scratch, name), join(scratch, after));
            let [pixels, ties, most, all] = [0, 0, 0, 0];
            for (const view of views) {
                for (const variant of variants) {
                    const before = await picture(`/${name}`, view, variant);
                    if (drawn(before) < 1000) faults.push(`${name}, ${view}: nothing is seen`);
                    const { places, most: by } = different(before, await picture(`/${after}`, view, variant));
                    const others = places.length ? await opaqueTies(picture, name, after, view, variant) : new Set();
                    const counted = places.filter((place) => !others.has(place)).length;
                    pixels += counted;
                    ties += places.length - counted;
                    if (counted) most = Math.max(most, by);
                    all += SIZE * SIZE;
                }
            }
            console.log(
                `${pixels ? "DIFFERENT: " : ""}${title}: ${pixels} of ${all} pixels differ, by ${most} at most` +
                    (ties ? `; besides ${ties} where opaque faces are at the same depth` : "") +
                    (isMoved ? "" : "; the file is as it was"),
            );
            if (pixels) failed += 1;
        }
    }

    // The check of the check: the same picture twice, and another one where the order is another.
    const [one, two] = [await picture("/seen.glb", "eye"), await picture("/seen.glb", "eye")];
    if (different(one, two).places.length) faults.push("one scene drawn twice gives two pictures");
    const flags = ["--reorder-transparent", "--cache", "fifo:16", "--quiet"];
    await run(program, ["optimize", join(scratch, "seen.glb"), "-o", join(scratch, "asked.glb"), ...flags]);
    for (const variant of [undefined, 0]) {
        const { places } = different(await picture("/seen.glb", "eye", variant), await picture("/asked.glb", "eye", variant));
        const title = `pictures: seen.glb, --reorder-transparent${variant === 0 ? ", variant" : ""}`;
        console.log(`${title}: ${places.length} of ${SIZE * SIZE} pixels differ, as they should`);
        if (places.length === 0) faults.push("transparent faces in another order do not show");
    }
    for (const fault of faults) console.log(`DIFFERENT: ${fault}`);
    failed += faults.length;
} finally {
    await close();
    await rm(scratch, { recursive: true, force: true });
}
if (failed) process.exitCode = 1;
