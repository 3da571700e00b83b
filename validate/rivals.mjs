// What each tool loses of a GLB when it is asked to re-order it as gently as it can, as a table.
// Fails if meshweft loses anything.
//
// Usage: node rivals.mjs MESHWEFT PYTHON

import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { isDeepStrictEqual, promisify } from "node:util";

import validator from "gltf-validator";

import { Glb } from "./glb.mjs";
import { make } from "./made.mjs";
import { objects, PRIVATE } from "./objects.mjs";

const [program, python] = process.argv.slice(2);
const run = promisify(execFile);
const beside = (path) => fileURLToPath(new URL(`node_modules/${path}`, import.meta.url));
const bin = (name) => beside(`.bin/${name}`);
const versionOf = async (name) => JSON.parse(await readFile(beside(`${name}/package.json`))).version;
const trimesh = "import sys, trimesh; trimesh.load_scene(sys.argv[1], process=False).export(sys.argv[2])";
const stdout = async (...command) => (await run(...command)).stdout.trim();

/** The tools: their version, and the command as it is printed and as it is run. */
const TOOLS = [
    {
        name: "meshweft",
        version: (await stdout(program, ["--version"])).split(" ").at(-1),
        shown: "meshweft optimize made.glb -o out.glb",
        command: (from, to) => [program, ["optimize", from, "-o", to, "--quiet"]],
    },
    {
        name: "gltf-transform",
        version: await versionOf("@gltf-transform/cli"),
        shown: "gltf-transform reorder made.glb out.glb --target performance",
        command: (from, to) => [bin("gltf-transform"), ["reorder", from, to, "--target", "performance"]],
    },
    {
        name: "gltfpack",
        version: await versionOf("gltfpack"),
        shown: "gltfpack -noq -kn -km -ke -kv -i made.glb -o out.glb",
        command: (from, to) => [bin("gltfpack"), ["-noq", "-kn", "-km", "-ke", "-kv", "-i", from, "-o", to]],
    },
    {
        name: "trimesh",
        version: await stdout(python, ["-c", "import trimesh; print(trimesh.__version__)"]),
        shown: `python -c "${trimesh}" made.glb out.glb`,
        command: (from, to) => [python, ["-c", trimesh, from, to]],
    },
];

/** Joints of a skin by the names of their nodes, with their weights; those without weight left out. */
function influences(glb, attributes, skin, vertex) {
    const pairs = attributes.JOINTS_0[vertex].map((joint, i) => [
        glb.json.nodes[skin.joints[joint]]?.name,
        attributes.WEIGHTS_0[vertex][i],
    ]);
    return pairs.filter(([, weight]) => weight > 0).sort();
}

/** All triangles of the file, sorted, with what `record` tells of each corner. */
function triangles(glb, record) {
    const all = [];
    (glb.json.meshes ?? []).forEach((mesh, number) => {
        const skin = glb.json.skins?.[glb.json.nodes.find((node) => node.mesh === number)?.skin];
        for (const primitive of mesh.primitives) {
            const read = (set) => Object.fromEntries(Object.entries(set).map(([name, n]) => [name, glb.elements(n)]));
            const attributes = read(primitive.attributes);
            const targets = (primitive.targets ?? []).map(read);
            const records = attributes.POSITION.map((position, vertex) =>
                JSON.stringify([position, record({ glb, skin, attributes, targets, vertex })]),
            );
            const corners = primitive.indices === undefined ? [...records.keys()] : glb.elements(primitive.indices).flat();
            for (let at = 0; at < corners.length; at += 3) {
                const [a, b, c] = [0, 1, 2].map((i) => records[corners[at + i]]);
                all.push([[a, b, c].join(), [b, c, a].join(), [c, a, b].join()].sort()[0]);
            }
        }
    });
    return all.sort();
}

/** What each row on attributes looks at. */
const RECORDS = {
    positions: () => [],
    everything: ({ attributes, targets, vertex }) => [
        Object.keys(attributes).sort().map((name) => [name, attributes[name][vertex]]),
        targets.map((target) => Object.keys(target).sort().map((name) => [name, target[name][vertex]])),
    ],
    skin: ({ glb, skin, attributes, vertex }) =>
        skin && attributes.JOINTS_0 && attributes.WEIGHTS_0 ? influences(glb, attributes, skin, vertex) : [],
    morph: ({ targets, vertex }) => targets.map(({ POSITION, NORMAL }) => [POSITION?.[vertex], NORMAL?.[vertex]]),
    custom: ({ attributes, vertex }) => attributes._TEMPERATURE?.[vertex],
};

/** The edges of all outlines as pairs of positions, sorted. */
function outlines(glb) {
    return glb.primitives().flatMap((primitive) => {
        const indices = primitive.extensions?.CESIUM_primitive_outline?.indices;
        if (indices === undefined || !glb.json.accessors[indices]) return [];
        const positions = glb.elements(primitive.attributes.POSITION);
        const ends = glb.elements(indices).map(([vertex]) => JSON.stringify(positions[vertex]));
        return ends.flatMap((end, i) => (i % 2 ? [] : [[end, ends[i + 1]].sort().join()]));
    }).sort();
}

/** The skins: their joints by name, and the matrices. */
const skins = (glb) =>
    (glb.json.skins ?? []).map(({ joints, inverseBindMatrices }) => [
        joints.map((joint) => glb.json.nodes[joint].name),
        inverseBindMatrices === undefined ? [] : glb.elements(inverseBindMatrices),
    ]);

const pointers = (glb) =>
    (glb.json.animations ?? [])
        .flatMap(({ channels }) => channels)
        .map(({ target }) => target.extensions?.KHR_animation_pointer?.pointer)
        .filter((pointer) => pointer !== undefined);

/** Whether `has` is all there and equal, there at all, or gone. */
function state(is, has) {
    if (isDeepStrictEqual(is, has)) return "kept";
    return has.length > 0 ? "changed" : "lost";
}

/** Whether a value is contained in another, which may have more fields. */
function isWithin(value, other) {
    if (value === null || typeof value !== "object") return value === other;
    if (other === null || typeof other !== "object" || Array.isArray(value) !== Array.isArray(other)) return false;
    return Object.keys(value).every((key) => isWithin(value[key], other[key]));
}

/** How many of the values are still there. */
function kept(before, after) {
    const left = [...after];
    const found = before.filter((value) => {
        const at = left.findIndex((other) => isWithin(value, other));
        if (at >= 0) left.splice(at, 1);
        return at >= 0;
    });
    return found.length;
}

const share = (before, after) => `${kept(before, after)} of ${before.length}`;

const KINDS = [...new Set([...objects(new Glb(make()).json)].map(({ kind }) => kind))];

/** Extras and private extensions of the objects of a kind, or of all. */
function carried(glb, kind) {
    const of = [...objects(glb.json)].filter((one) => kind === undefined || one.kind === kind);
    const all = (read) => of.map((one) => [one.kind, read(one.object)]).filter(([, value]) => value !== undefined);
    return { extras: all(({ extras }) => extras), extensions: all(({ extensions }) => extensions?.[PRIVATE]) };
}

async function acmr(file) {
    const report = JSON.parse(await stdout(program, ["inspect", "--json", "--cache", "fifo:12", file]));
    return report.total.acmr["fifo:12"].toFixed(3);
}

async function measure(source, from, result, to) {
    const [bytes, made] = [await readFile(from), await readFile(to)];
    const same = (name) => isDeepStrictEqual(triangles(source, RECORDS[name]), triangles(result, RECORDS[name]));
    const withData = (name, objectState, hasData) => {
        if (objectState === "lost" || !hasData) return "lost";
        return same(name) && objectState === "kept" ? "kept" : "changed";
    };
    const has = (name) => result.primitives().some(({ attributes }) => attributes[name] !== undefined);
    const sparse = (glb) => (glb.json.accessors ?? []).filter((a) => a.sparse).map((a) => [a.type, a.sparse.count]);
    const namesOf = (glb) => (glb.json.meshes ?? []).map(({ name }) => name);
    const report = await validator.validateBytes(new Uint8Array(made));
    const rows = {
        "triangles by position": same("positions") ? "kept" : "changed",
        "triangles with every attribute": same("everything") ? "kept" : "changed",
        "skin": withData("skin", state(skins(source), skins(result)), has("JOINTS_0")),
        "morph target": withData("morph", "kept", result.primitives().some(({ targets }) => targets)),
        "custom attribute": withData("custom", "kept", has("_TEMPERATURE")),
        "mesh names": share(namesOf(source), namesOf(result)),
        "edges of `CESIUM_primitive_outline`": state(outlines(source), outlines(result)),
        "`KHR_animation_pointer`": state(pointers(source), pointers(result)),
        "sparse accessor": state(sparse(source), sparse(result)),
        "JSON chunk, byte for byte": source.jsonBytes.equals(result.jsonBytes) ? "kept" : "changed",
    };
    for (const kind of [undefined, ...KINDS]) {
        const [is, now] = [carried(source, kind), carried(result, kind)];
        const row = kind === undefined ? "**all objects**" : kind;
        const extensions = is.extensions.length ? share(is.extensions, now.extensions) : "–";
        rows[`${row}: extras; private extension`] = `${share(is.extras, now.extras)}; ${extensions}`;
    }
    rows["errors found by the Khronos validator"] = String(report.issues.numErrors);
    rows["bytes"] = `${bytes.length} → ${made.length}`;
    rows["misses per face, fifo:12"] = `${await acmr(from)} → ${await acmr(to)}`;
    return rows;
}

/** Whether a cell tells of a loss. */
function isLoss(cell) {
    const parts = [...cell.matchAll(/(\d+) of (\d+)/g)];
    return /lost|changed/.test(cell) || parts.some(([, some, all]) => some !== all);
}

const scratch = await mkdtemp(join(tmpdir(), "meshweft-rivals-"));
try {
    const from = join(scratch, "made.glb");
    await writeFile(from, make());
    const source = new Glb(await readFile(from));
    const columns = [];
    for (const { name, command } of TOOLS) {
        const to = join(scratch, `${name}.glb`);
        await run(...command(from, to));
        columns.push(await measure(source, from, new Glb(await readFile(to)), to));
    }
    const line = (cells) => `| ${cells.join(" | ")} |`;
    console.log(line(["kept of a GLB", ...TOOLS.map(({ name, version }) => `${name} ${version}`)]));
    console.log(line(["---", ...TOOLS.map(() => "---")]));
    for (const row of Object.keys(columns[0])) console.log(line([row, ...columns.map((column) => column[row])]));
    console.log();
    for (const { name, version, shown } of TOOLS) console.log(`- ${name} ${version}: \`${shown}\``);
    const losses = Object.entries(columns[0]).filter(([, cell]) => isLoss(cell));
    for (const [row, cell] of losses) console.error(`DIFFERENT: meshweft: ${row}: ${cell}`);
    if (losses.length > 0 || columns[0]["errors found by the Khronos validator"] !== "0") process.exitCode = 1;
} finally {
    await rm(scratch, { recursive: true, force: true });
}
