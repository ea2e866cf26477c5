// Run by three.sh: node three.cjs FOLDER SCENE SCREENSHOT. The folder holds unlit.glb, bake.glb and
// table.csv of one run, of the patch mesh, flat: every face has its patch's radiosity.
const fs = require("fs");
const http = require("http");
const path = require("path");
const puppeteer = require("puppeteer-core");

const [folder, scene, screenshot] = process.argv.slice(2);
// The package's main file lies in its folder build/.
const three = path.dirname(path.dirname(require.resolve("three")));

// Serves the page, three.js and the run's files, to this machine alone.
function serve(request, response) {
    const url = decodeURIComponent(request.url);
    const file = url === "/" ? path.join(__dirname, "three.html")
        : url.startsWith("/three/") ? path.join(three, path.normalize(url).slice(7))
        : url === "/scene" ? scene
        : path.join(folder, path.basename(url));
    const types = { ".html": "text/html", ".js": "text/javascript" };
    fs.readFile(file, (error, bytes) => {
        response.writeHead(error ? 404 : 200,
            { "Content-Type": types[path.extname(file)] || "application/octet-stream" });
        response.end(bytes);
    });
}

function table(file) {
    const [head, ...rows] = fs.readFileSync(file, "utf8").trim().split("\n").map((r) => r.split(","));
    return rows.map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])));
}

// 50 rows, the same in every run.
function sample(rows) {
    let state = 1;
    return Array.from({ length: 50 }, () => {
        state = (state * 48271) % 0x7fffffff;
        return rows[state % rows.length];
    });
}

const srgb = (x) => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const largest = (a, b, scale) => Math.max(...a.map((x, i) => Math.abs(x - b[i]) / scale(b[i])));

// Largest relative difference of vertex colours, and, of those drawn, of levels of a pixel.
async function compare(page, name, rows) {
    const { clamped, exposure } = await page.evaluate((file) => window.show(file), name);
    let colour = 0, level = 0, drawn = 0;
    for (const row of rows) {
        const numbers = (names) => names.map((key) => Number(row[key]));
        const wanted = numbers(["radiosity_r", "radiosity_g", "radiosity_b"])
            .map((b) => (clamped ? Math.min(b * exposure, 1) : b * exposure));
        const got = await page.evaluate((p, n) => window.look(p, n), numbers(["x", "y", "z"]),
            numbers(["nx", "ny", "nz"]));
        colour = Math.max(colour, largest(got.colour, wanted, (x) => Math.max(x, 1e-6)));
        if (clamped && got.pixel) {
            level = Math.max(level, largest(got.pixel, wanted.map(srgb), () => 1));
            ++drawn;
        }
    }
    console.log(`three.js: ${name}: 50 patches, vertex colours within ${colour.toExponential(1)}` +
        (clamped ? `, ${drawn} seen, pixels within ${level.toFixed(2)} of 255 levels` : ""));
    return colour < 1e-5 && level <= 1 && (!clamped || drawn >= 10);
}

async function valid(name) {
    let validator;
    try {
        validator = require("gltf-validator");
    } catch {
        return true;
    }
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path.join(folder, name))));
    const { numErrors, numWarnings, messages } = report.issues;
    console.log(`gltf-validator: ${name}: ${numErrors} errors, ${numWarnings} warnings`);
    if (numErrors > 0)
        console.log(messages[0]);
    return numErrors === 0;
}

async function main() {
    const server = http.createServer(serve).listen(0, "127.0.0.1");
    await new Promise((ready) => server.once("listening", ready));
    const browser = await puppeteer.launch({
        executablePath: process.env.CHROMIUM,
        args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    });
    try {
        const page = await browser.newPage();
        page.on("pageerror", (error) => console.log(String(error)));
        await page.setViewport({ width: 400, height: 400 });
        await page.goto(`http://127.0.0.1:${server.address().port}/`);
        await page.waitForFunction("window.show");
        const rows = sample(table(path.join(folder, "table.csv")));
        let good = await compare(page, "bake.glb", rows);
        good = (await compare(page, "unlit.glb", rows)) && good;
        await page.screenshot({ path: screenshot });
        for (const name of ["bake.glb", "unlit.glb", "map.glb"])
            good = (await valid(name)) && good;
        return good ? 0 : 1;
    } finally {
        await browser.close();
        server.close();
    }
}

main().then((code) => process.exit(code), (error) => {
    console.log(String(error));
    process.exit(1);
});
