// The motion: energy along a run, a robot that is dropped, what is drawn, and how fast.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, test } from "node:test";
import { answered, model, opened, picture, root, stopped, typed } from "./browser.mjs";

after(stopped);

async function shown(page) {
  await page.click("#tab-motion");
  await page.waitForFunction(() => document.querySelector("#summary").dataset.drift !== undefined && document.body.dataset.motion !== undefined, undefined, {
    timeout: 120_000,
  });
}

// How many points of the scene are not of the colour behind it.
function drawn(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector(".stage canvas");
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d");
    globalThis.hamelMotion.draw();
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let points = 0;
    for (let at = 3; at < data.length; at += 4) {
      points += data[at] > 128 ? 1 : 0;
    }
    return points;
  });
}

async function dropped(page, path, name) {
  const text = await readFile(path, "utf8");
  await page.evaluate(
    ([text, name]) => {
      const data = new DataTransfer();
      data.items.add(new File([text], name, { type: "application/xml" }));
      const target = document.querySelector("#editor .cm-content");
      for (const kind of ["dragenter", "dragover", "drop"]) {
        target.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
      }
    },
    [text, name],
  );
  await page.waitForFunction(() => globalThis.hamelText().includes("joint"));
  await answered(page);
}

test("a run keeps its energy, and can be played, moved through and changed", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  await typed(page, await model("heavy_top"));
  await shown(page);
  const drift = Number(await page.getAttribute("#summary", "data-drift"));
  assert.ok(drift > 0 && drift < 1e-9, `energy changes by ${drift}`);
  assert.ok((await drawn(page)) > 1000);
  // Velocities, energy, and what the description claims to be constant.
  const titles = await page.$$eval(".plots figcaption", (list) => list.map((one) => one.textContent));
  assert.ok(titles.includes("velocities"), titles.join());
  assert.ok(titles.some((title) => title.startsWith("energy less its start")), titles.join());
  await page.click("#play");
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 0.1);
  await page.click("#play");
  assert.equal(await page.textContent("#play"), "Play");
  await picture(page, "motion");
  const before = await page.$eval(".plots polyline", (line) => line.getAttribute("points"));
  // Another start: another run.
  const field = page.locator(".start input").last();
  await field.fill("9");
  await page.waitForFunction((before) => document.querySelector(".plots polyline").getAttribute("points") !== before, before);
  // Another method and step.
  await page.selectOption("#method", "rkmk4");
  await page.fill("#step", "0.05");
  await page.press("#step", "Enter");
  await page.waitForFunction(() => /^rkmk4; 200 steps/.test(document.querySelector("#summary").textContent));
  await page.click("#compare");
  await page.waitForSelector('svg[aria-label^="error at t"] polyline', { timeout: 120_000 });
  assert.ok((await page.$$eval('svg[aria-label^="error at t"] polyline', (list) => list.length)) >= 4);
  assert.deepEqual(left, []);
  await close();
});

test("an example of the menu runs for as long as it says", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  await page.selectOption("#examples", { label: "peaucellier" });
  await answered(page);
  await shown(page);
  const text = await readFile(join(root, "examples", "gallery", "peaucellier.eom"), "utf8");
  const [, until] = /^\/\/ run: .*--until (\S+)/m.exec(text);
  assert.equal(await page.inputValue("#until"), until);
  assert.equal(await page.$eval('.controls input[type="range"]', (range) => range.max), until);
  await page.$eval('.controls input[type="range"]', (range) => {
    range.value = String(0.4 * Number(range.max));
    range.dispatchEvent(new Event("input"));
  });
  assert.ok((await drawn(page)) > 1000);
  await picture(page, "example");
  assert.deepEqual(left, []);
  await close();
});

test("a robot that is dropped is drawn sixty times a second", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  await page.check("#floating");
  const solo = join(process.env.HAMEL_ROBOTS, "solo_description", "robots", "solo12.urdf");
  await dropped(page, solo, "solo12.urdf");
  assert.match(await page.evaluate(() => globalThis.hamelText()), /pub system Solo/);
  assert.equal(await page.$$eval(".message.error", (list) => list.length), 0);
  await page.click("#tab-motion");
  await page.fill("#until", "1");
  await page.press("#until", "Enter");
  await shown(page);
  assert.ok((await drawn(page)) > 1000);
  const places = await page.$eval(".plots polyline", (line) => line.getAttribute("points").split(" ").length);
  assert.ok(places >= 300, `${places} samples`);
  // What the page does for a frame, whatever draws it: software here, a graphics card elsewhere.
  const { frame, calls } = await page.evaluate(() => globalThis.hamelMotion.measure(200));
  console.log(`Solo12: ${frame.toFixed(2)} ms of work for a frame, ${calls} calls of the graphics card`);
  assert.ok(frame < 1000 / 60, `${frame} ms`);
  assert.ok(calls < 300, `${calls} calls`);
  await picture(page, "solo12");
  assert.deepEqual(left, []);
  await close();
});
