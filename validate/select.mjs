// The Khronos validator reads every glTF before and after every second face of each mesh was left out, with
// the vertices that no other uses: it must find nothing that it did not find before.
//
// Usage: node select.mjs MESHWEFT_APPEND DATA_FOLDER

import { execFile } from "node:child_process";
import { mkdir, mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join, relative } from "node:path";
import { promisify } from "node:util";

import { filesBelow, findings, isError, names } from "./reading.mjs";

const [program, data] = process.argv.slice(2);
const run = promisify(execFile);
/** Errors and warnings; what is not used, for example, is information. */
const WARNING = 1;

/** Refused though the validator finds no error: names that systems read in different ways. */
const REFUSED_BY_DESIGN = ["reports/uri-backslash/m.gltf"];

/** How often each kind of error or warning is found. */
function kinds({ messages }) {
    const counts = new Map();
    for (const { severity, code } of messages) {
        if (severity <= WARNING) counts.set(code, (counts.get(code) ?? 0) + 1);
    }
    return counts;
}

const work = await mkdtemp(join(tmpdir(), "meshweft-select-"));
const problems = [];
const refused = [];
let [scenes, facesBefore, facesAfter, found] = [0, 0, 0, 0];
for (const source of await filesBelow(data)) {
    const name = relative(data, source);
    const before = await findings(source, basename(source));
    const folder = join(work, String(scenes));
    await mkdir(folder);
    const result = join(folder, basename(source));
    const output = await run(program, ["select", source, result]).catch((error) => error);
    if (output instanceof Error) {
        // What is not a sound glTF may be refused, and what is may not.
        refused.push(name);
        const isSound = !before.messages.some(isError) && !REFUSED_BY_DESIGN.includes(name);
        if (isSound) problems.push(`${name}: ${output.stderr}`);
        await rm(folder, { recursive: true });
        continue;
    }
    const [old, now] = output.stdout.trim().split("\t").map(Number);
    const after = kinds(await findings(result, basename(result)));
    for (const [code, count] of after) {
        found += count;
        const earlier = kinds(before).get(code) ?? 0;
        if (count > earlier) problems.push(`${name}: ${code} ${count} times, before ${earlier} times`);
    }
    scenes += 1;
    facesBefore += old;
    facesAfter += now;
}
await rm(work, { recursive: true, force: true });

for (const problem of problems) console.log(`DIFFERENT: ${problem}`);
console.log(
    `select, Khronos validator: ${scenes} scenes, ${facesAfter} of ${facesBefore} faces left, ${found} errors and ` +
        `warnings, none that was not there before; refused by meshweft: ${refused.length}${names(refused)}`,
);
process.exitCode = problems.length ? 1 : 0;
