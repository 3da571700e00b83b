// What the checks of glTF files share: the files, their JSON, and what the Khronos validator finds.

import { copyFile, mkdir, readdir, readFile, rm } from "node:fs/promises";
import { basename, dirname, join, relative } from "node:path";

import validator from "gltf-validator";

import { Glb } from "./glb.mjs";

export const isGlb = (file) => file.endsWith(".glb");
export const isError = ({ severity }) => severity === 0;
export const names = (list) => (list.length ? ` (${list.join(", ")})` : "");

export async function filesBelow(folder) {
    const entries = await readdir(folder, { recursive: true, withFileTypes: true });
    const files = entries.filter((entry) => entry.isFile()).map((entry) => join(entry.parentPath, entry.name));
    return files.filter((file) => /\.(glb|gltf)$/.test(file)).sort();
}

/** Copies all files; the folders may be written, whatever those of the source may. */
async function copyBelow(from, to) {
    for (const entry of await readdir(from, { recursive: true, withFileTypes: true })) {
        const target = join(to, relative(from, entry.parentPath));
        await mkdir(target, { recursive: true });
        if (entry.isFile()) await copyFile(join(entry.parentPath, entry.name), join(target, entry.name));
    }
}

/**
 * Copies the folder of a .gltf, but not the file itself and its buffers: those are written with it, and
 * would not be written over the files of somebody else.
 */
export async function copyAround(source, folder) {
    await copyBelow(dirname(source), folder);
    await rm(join(folder, basename(source)), { force: true });
    const { buffers } = await jsonOf(source).catch(() => ({}));
    for (const { uri } of Array.isArray(buffers) ? buffers : []) {
        // Names that are not plain are left: what they stand for may be anywhere.
        const isPlain = typeof uri === "string" && /^[\w. -]+(\/[\w. -]+)*$/.test(uri) && !uri.includes("..");
        if (isPlain) await rm(join(folder, uri), { force: true });
    }
}

export async function jsonOf(file) {
    const bytes = await readFile(file);
    return isGlb(file) ? new Glb(bytes).json : JSON.parse(bytes.toString());
}

/** Whether the file or a buffer beside it was changed. */
export async function isChanged(before, after) {
    const content = async (file) => {
        const uris = isGlb(file) ? [] : ((await jsonOf(file)).buffers ?? []).map(({ uri }) => uri);
        const names = uris.filter((uri) => uri && !uri.startsWith("data:")).map(decodeURIComponent);
        const files = [file, ...names.map((name) => join(dirname(file), name))];
        return Buffer.concat(await Promise.all(files.map((one) => readFile(one))));
    };
    return !(await content(before)).equals(await content(after));
}

/** What the Khronos validator finds, and what it counts. */
export async function findings(file, uri) {
    const validated = validator.validateBytes(new Uint8Array(await readFile(file)), {
        uri,
        maxIssues: 0,
        externalResourceFunction: async (name) => {
            const bytes = await readFile(join(dirname(file), name)).catch(() => {
                // The system's error text names the folder.
                throw new Error("not there");
            });
            return new Uint8Array(bytes);
        },
    });
    return validated.then(
        (report) => ({ messages: report.issues.messages, counts: JSON.stringify(report.info) }),
        // A file that is not a glTF makes no report.
        (error) => ({ messages: [{ severity: 0, code: "NOT_READ", message: String(error) }], counts: "" }),
    );
}
