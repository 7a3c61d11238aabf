// The page in Chromium. Any request to the network fails the test.

import { chromium } from "playwright-core";
import { spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");
export const built = join(root, "bindings", "page", "dist", "index.html");
export const address = pathToFileURL(built).href;

const FLAGS = [
  "--no-sandbox",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
];

let browser;

export async function started() {
  browser ??= await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: FLAGS });
  return browser;
}

export async function stopped() {
  await browser?.close();
}

// Opens the page in a new window, and waits until it is ready; `left` collects forbidden requests and errors.
export async function opened(url = address, options = {}) {
  const context = await (await started()).newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  const left = [];
  page.on("request", (request) => {
    if (!/^(file:|data:|blob:|http:\/\/localhost:)/.test(request.url())) {
      left.push(`request of ${request.url()}`);
    }
  });
  page.on("pageerror", (error) => left.push(`error: ${error.message}`));
  page.on("console", (message) => {
    if (message.type() === "error") {
      left.push(`console: ${message.text()}`);
    }
  });
  await page.goto(url);
  await page.waitForSelector("body[data-ready]", { timeout: 60_000 });
  return { page, left, close: () => context.close() };
}

// Pastes a text into the editor, and waits for the answer.
export async function typed(page, text) {
  await page.click(".cm-content");
  await page.keyboard.press("Control+A");
  await page.keyboard.insertText(text);
  await answered(page);
}

export async function answered(page, timeout = 120_000) {
  await page.waitForFunction(() => document.body.dataset.answered === "yes", undefined, { timeout });
}

// Sends a request directly to the generator of the page, and returns the answer.
export async function asked(page, what, request = {}) {
  return page.evaluate(([what, request]) => globalThis.hamel.ask(what, request), [what, request]);
}

// Saves a screenshot to the folder HAMEL_PICTURES, if set.
export async function picture(page, name) {
  if (process.env.HAMEL_PICTURES !== undefined) {
    await page.screenshot({ path: join(process.env.HAMEL_PICTURES, `page-${name}.png`) });
  }
}

// Runs the command line.
export function said(words, input) {
  const { status, stdout, stderr } = spawnSync(process.env.HAMEL ?? join(root, "target", "debug", "hamel"), words, {
    cwd: root,
    input,
    encoding: "utf8",
    maxBuffer: 1 << 28,
  });
  return { status, stdout, stderr };
}

export async function model(name) {
  return readFile(join(root, "tests", "models", `${name}.eom`), "utf8");
}

// Serves the page like a static host.
export async function served() {
  const server = createServer(async (request, answer) => {
    const path = new URL(request.url, "http://localhost").pathname;
    if (path !== "/" && path !== "/index.html") {
      answer.writeHead(404).end();
      return;
    }
    answer.writeHead(200, { "content-type": "text/html; charset=utf-8" }).end(await readFile(built));
  });
  await new Promise((resolve) => server.listen(0, "localhost", resolve));
  return { url: `http://localhost:${server.address().port}/`, close: () => server.close() };
}
