// A page with three.js in headless Chromium, with its software rasteriser: Debian's package, or CHROMIUM, the path of
// another.

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

import { chromium } from "playwright-core";

const here = dirname(fileURLToPath(import.meta.url));
const MEDIA = { ".html": "text/html", ".js": "text/javascript", ".png": "image/png", ".gltf": "model/gltf+json" };
/** In place of textures that the test data does not have. */
const GREY = Buffer.from(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==",
    "base64",
);
const IMPORTS = `<!doctype html><script type="importmap">{"imports": {
    "three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}</script>`;

/** Serves the page, three.js, and a folder of scenes, to this machine alone. */
function serve(script, scenes) {
    const server = createServer(async ({ url }, answer) => {
        const path = normalize(decodeURIComponent(new URL(url, "http://localhost").pathname));
        const send = (bytes, ending) => answer
            .writeHead(200, { "content-type": MEDIA[ending] ?? "model/gltf-binary", "cache-control": "no-store" })
            .end(bytes);
        if (path === "/") return send(`${IMPORTS}<script type="module">${script}\nwindow.isReady = true;</script>`, ".html");
        const file = path.startsWith("/three/") ? join(here, "node_modules", path) : join(scenes, path);
        const isPicture = [".png", ".jpg", ".jpeg"].includes(extname(file));
        const bytes = await readFile(file).catch(() => (isPicture ? GREY : undefined));
        return bytes ? send(bytes, isPicture ? ".png" : extname(file)) : answer.writeHead(404).end();
    });
    return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

/** Opens a page that has run a script; `faults` gets what it throws. Close it. */
export async function openPage(script, scenes, faults) {
    const server = await serve(script, scenes);
    const browser = await chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
            "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
    });
    const close = async () => {
        await browser.close();
        server.close();
    };
    try {
        const page = await browser.newPage();
        page.on("pageerror", (error) => faults.push(String(error)));
        await page.goto(`http://127.0.0.1:${server.address().port}/`);
        await page.waitForFunction("window.isReady === true");
        return { page, close };
    } catch (error) {
        await close();
        throw error;
    }
}
