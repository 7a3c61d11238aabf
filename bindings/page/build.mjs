// Assembles the page into a single file, bindings/page/dist/index.html, which needs no other files and no server.

import { build, transform } from "esbuild";
import { mkdir, readFile, readdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import subsetFont from "subset-font";
// Internal modules, since the exports of the package do not allow context bits to be set.
import { Encoder } from "./node_modules/lzma1/lib/encoder.js";
import { MODES } from "./node_modules/lzma1/lib/lzma.js";
import { InputBuffer, OutputBuffer } from "./node_modules/lzma1/lib/streams.js";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "..", "..");
const target = process.env.CARGO_TARGET_DIR ?? join(root, "target");

// Removes the encoder from the page, which only decompresses.
const unpacking = {
  name: "unpacking",
  setup(build) {
    build.onLoad({ filter: /lzma1.lib.encoder\.js$/ }, () => ({ contents: "export class Encoder {}" }));
  },
};

async function bundled(entry) {
  const result = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    write: false,
    legalComments: "none",
    plugins: [unpacking],
  });
  return result.outputFiles[0].text;
}

const from = (first, last) => String.fromCodePoint(...Array.from({ length: last - first + 1 }, (_, i) => first + i));

// Characters of the generator's formulas: ASCII, Greek, operators and accents; brackets and roots of every size, with
// the pieces from which large ones are assembled.
const letters = from(0x20, 0x7e) + from(0x391, 0x3f6) + "·×÷±¬°−∓∂∇∑∏√∞≈≡≠≤≥∈∘…⋯⋮⋱′⟨⟩∣∥⌊⌋⌈⌉→⊤⊥¨¯´`ˆ˙˜ˇ˘⃗\u00a0ıȷ";
const brackets = "()[]{}⟨⟩⌊⌋⌈⌉∣∥⏐∑∏∫√\ue000\ue001" + from(0x239b, 0x23ad);

// The style sheet of KaTeX, with subsets of the fonts that the formulas need, followed by the style sheet of the page.
async function style() {
  const katex = dirname(createRequire(import.meta.url).resolve("katex/dist/katex.min.css"));
  let css = await readFile(join(katex, "katex.min.css"), "utf8");
  const needed = /KaTeX_(Main-Regular|Math-Italic|Size[1-4]-Regular)/;
  const faces = [...css.matchAll(/@font-face\{[^}]*\}/g)].map((match) => match[0]);
  for (const face of faces) {
    const file = /url\((fonts\/[^)]*\.woff2)\)/.exec(face)[1];
    const signs = file.includes("Size") ? brackets : letters;
    const font = needed.test(file) ? await subsetFont(await readFile(join(katex, file)), signs, { targetFormat: "woff2" }) : null;
    const inline = font && face.replace(/src:[^}]*/, `src:url(data:font/woff2;base64,${font.toString("base64")}) format("woff2")`);
    css = css.replace(face, inline ?? "");
  }
  const own = await readFile(join(here, "src", "style.css"), "utf8");
  const { code } = await transform(css + own, { loader: "css", minify: true });
  return code;
}

// Wraps a remark into comment lines that fit the editor.
function commented(remark) {
  return remark.replace(/(.{1,76})(\s+|$)/g, "// $1\n").trimEnd();
}

// The examples, sorted by name: text without the options of the gallery, and length of a run (s).
async function examples() {
  const folders = [join(root, "examples"), join(root, "examples", "gallery")];
  const all = [];
  for (const folder of folders) {
    for (const file of (await readdir(folder)).filter((file) => file.endsWith(".eom"))) {
      const written = await readFile(join(folder, file), "utf8");
      const text = written.replace(/^\/\/ (draw|run|keeps): .*\n/gm, "").replace(/^\/\/ remark: (.*)$/gm, (_, remark) => commented(remark));
      const until = Number(/^\/\/ run: .*--until (\S+)/m.exec(written)?.[1] ?? 10);
      all.push({ name: file.replace(/\.eom$/, ""), text, until });
    }
  }
  return all.sort((a, b) => (a.name < b.name ? -1 : 1));
}

// LZMA without position bits, since WebAssembly and text have no alignment, and with more literal context bits instead.
class Unaligned extends Encoder {
  constructor(bits) {
    super();
    this.bits = bits;
  }

  configure(mode) {
    super.configure(mode);
    [this._numLiteralContextBits, this._posStateBits, this._posStateMask] = [this.bits, 0, 0];
  }
}

// Imports a module of the page's sources for use in this script.
async function module(file) {
  const { code } = await transform(await readFile(join(here, "src", file), "utf8"), { loader: "ts", format: "esm" });
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}

// Compresses with LZMA, whose output is a quarter smaller than gzip's, and encodes in base64.
function packed(bytes, bits = 4) {
  const output = new OutputBuffer(bytes.length);
  new Unaligned(bits).compress(new InputBuffer(bytes), output, MODES[9]);
  return Buffer.from(output.toArray()).toString("base64");
}

const inScript = (text) => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");

const [wasm, page, loader, worker, css, list, html] = await Promise.all([
  readFile(join(target, "page", "hamel_page.small.wasm")),
  bundled("main.ts"),
  bundled("loader.ts"),
  bundled("worker.ts"),
  style(),
  examples(),
  readFile(join(here, "src", "index.html"), "utf8"),
]);
const put = (text, place, part) => {
  if (!text.includes(place)) {
    throw new Error(`index.html has no place for ${place}`);
  }
  return text.replace(place, () => part);
};
let whole = html;
const { splitStreams, joinStreams } = await module("instructions.ts");
const streams = splitStreams(wasm);
if (!WebAssembly.validate(joinStreams(streams)) || Buffer.compare(splitStreams(joinStreams(streams)), streams) !== 0) {
  throw new Error("the module reassembled from its streams differs from the original");
}
const generator = packed(streams, 2);
const script = packed(Buffer.from(page));
whole = put(whole, "/* style */", css);
whole = put(whole, 'id="module">', `id="module">${generator}`);
whole = put(whole, 'id="worker">', `id="worker">${inScript(worker)}`);
whole = put(whole, 'id="examples-packed">', `id="examples-packed">${packed(Buffer.from(JSON.stringify(list)))}`);
whole = put(whole, 'id="page">', `id="page">${script}`);
whole = put(whole, "/* loader */", inScript(loader));

await mkdir(join(here, "dist"), { recursive: true });
await writeFile(join(here, "dist", "index.html"), whole);
const size = (text) => gzipSync(text, { level: 9 }).length;
console.log(
  `bindings/page/dist/index.html: ${size(whole).toLocaleString("en")} bytes gzipped; module ${size(generator).toLocaleString("en")}, ` +
    `script ${size(script).toLocaleString("en")}, style ${size(css).toLocaleString("en")}, ${list.length} examples`,
);
