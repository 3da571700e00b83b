// What a file that something was added to must keep: its JSON, its bytes, what the Khronos validator finds.

import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";

import { Glb } from "./glb.mjs";
import { isGlb } from "./reading.mjs";

/** What of the old JSON is not in the new one at its place; lengths of buffers are told apart. */
export function notContained(old, now, pointer, grown) {
    if (Array.isArray(old) && Array.isArray(now)) {
        if (now.length < old.length) return [`${pointer}: shorter`];
        return old.flatMap((value, i) => notContained(value, now[i], `${pointer}/${i}`, grown));
    }
    if (old !== null && typeof old === "object" && now !== null && typeof now === "object") {
        return Object.entries(old).flatMap(([name, value]) => {
            return name in now ? notContained(value, now[name], `${pointer}/${name}`, grown) : [`${pointer}/${name}: gone`];
        });
    }
    if (old === now) return [];
    const [, list, number, member, ...more] = pointer.split("/");
    const isLength = list === "buffers" && member === "byteLength" && more.length === 0 && now > old;
    // The data of a buffer in the text; it is compared as bytes.
    const isData = list === "buffers" && member === "uri" && String(now).startsWith("data:");
    if (!isLength && !isData) return [`${pointer}: ${old} | ${now}`];
    grown.add(number);
    return [];
}

/** The bytes of each buffer that can be read, the binary chunk with what follows it in its chunk. */
export async function buffersOf(file, json) {
    const glb = isGlb(file) ? new Glb(await readFile(file)) : undefined;
    const bytes = async ({ uri }, number) => {
        if (uri === undefined) return number === 0 && glb ? glb.buffers[0] : undefined;
        if (uri.startsWith("data:")) return Buffer.from(uri.slice(uri.indexOf(",") + 1), "base64");
        return readFile(join(dirname(file), decodeURIComponent(uri))).catch(() => undefined);
    };
    return Promise.all((json.buffers ?? []).map(bytes));
}

/** Findings that one list has more often than the other, one by one, each message as `worded`. */
function moreOften(list, than, worded) {
    const text = (finding) => `${finding.severity} ${finding.code} ${finding.pointer ?? finding.offset} ${worded(finding)}`;
    const counts = new Map();
    for (const finding of than) counts.set(text(finding), (counts.get(text(finding)) ?? 0) + 1);
    return list.filter((finding) => {
        const left = counts.get(text(finding)) ?? 0;
        counts.set(text(finding), left - 1);
        return left <= 0;
    });
}

/**
 * What the validator finds no more, what it finds again through elements that the old JSON does not have (it has found
 * the like before), and what is new.
 */
export function findingChanges(before, after, json, worded = ({ message }) => message) {
    const [again, added] = [[], []];
    for (const found of moreOften(after, before, worded)) {
        const [, list, number] = (found.pointer ?? "").split("/");
        const isNew = Number(number) >= (json[list]?.length ?? 0);
        const isKnown = before.some(({ code, pointer }) => code === found.code && pointer?.split("/")[1] === list);
        (isNew && isKnown ? again : added).push(found);
    }
    return { lost: moreOften(before, after, worded), again, added };
}

/** The text of each number, string, true, false and null in a JSON text, by its pointer. */
export function plainValues(text) {
    const tokens = text.matchAll(/"(?:[^"\\]|\\.)*"|[^\s"[\]{},:]+|[[\]{},:]/g);
    const next = () => tokens.next().value?.[0];
    const found = new Map();
    const read = (token, pointer) => {
        if (token === "[") {
            let item = next();
            for (let number = 0; item !== "]"; number++) {
                read(item, `${pointer}/${number}`);
                item = next();
                if (item === ",") item = next();
            }
        } else if (token === "{") {
            let name = next();
            while (name !== "}") {
                next();
                read(next(), `${pointer}/${JSON.parse(name)}`);
                name = next();
                if (name === ",") name = next();
            }
        } else {
            found.set(pointer, token);
        }
    };
    read(next(), "");
    return found;
}
