// The motion: energy along a run, a robot dropped onto the editor, the picture and its speed.

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

// Counts the pixels of the scene that are not background.
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

async function gallery(name) {
  return readFile(join(root, "examples", "gallery", `${name}.eom`), "utf8");
}

// Counts the red pixels near a point of the window.
function red(page, [x, y]) {
  return page.evaluate(
    ([x, y]) => {
      const canvas = document.querySelector(".stage canvas");
      const box = canvas.getBoundingClientRect();
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext("2d");
      globalThis.hamelMotion.draw();
      context.drawImage(canvas, 0, 0);
      const scale = canvas.width / box.width;
      const { data } = context.getImageData((x - box.left) * scale - 8, (y - box.top) * scale - 8, 16, 16);
      let points = 0;
      for (let at = 0; at < data.length; at += 4) {
        points += data[at + 3] > 128 && data[at] > 1.3 * data[at + 1] && data[at] > 1.3 * data[at + 2] ? 1 : 0;
      }
      return points;
    },
    [x, y],
  );
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
  const top = await gallery("heavy_top");
  await typed(page, top);
  await shown(page);
  const drift = Number(await page.getAttribute("#summary", "data-drift"));
  assert.ok(drift > 0 && drift < 1e-9, `energy changes by ${drift}`);
  assert.ok((await drawn(page)) > 1000);
  // Plots of velocities, energy, and the invariants of the description.
  const titles = await page.$$eval(".plots figcaption", (list) => list.map((one) => one.textContent));
  assert.ok(titles.includes("velocities"), titles.join());
  assert.ok(titles.some((title) => title.startsWith("energy minus its initial value")), titles.join());
  const claimed = [...top.matchAll(/^ *invariant (\w+)/gm)].filter(([, name]) => name !== "energy").map(([, name]) => `invariant ${name}`);
  assert.ok(claimed.length > 1);
  for (const title of claimed) {
    assert.ok(titles.includes(title), `${title} of ${titles.join()}`);
  }
  await page.click("#play");
  await page.waitForFunction(() => Number.parseFloat(document.querySelector(".clock").textContent) > 0.1);
  await page.click("#play");
  assert.equal(await page.textContent("#play"), "Play");
  await picture(page, "motion");
  const before = await page.$eval(".plots polyline", (line) => line.getAttribute("points"));
  // Another start gives another run.
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

test("a run without an end gives way to what is wanted next", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  await typed(page, await model("pendulum"));
  await shown(page);
  const summary = (pattern) =>
    page.waitForFunction((pattern) => new RegExp(pattern).test(document.querySelector("#summary").textContent), pattern, { timeout: 20_000 });
  const step = async (text) => {
    await page.fill("#step", text);
    await page.press("#step", "Enter");
  };
  await page.selectOption("#method", "rkmk4");
  await summary("^rkmk4; [0-9,]+ steps");
  await step("0.0000000001");
  await summary("^running…$");
  await step("0.01");
  await summary("^rkmk4; 1,000 steps");
  // A new worker opens the description for other requests as well, also after a file that is not a robot.
  await page.click("#tab-identities");
  await page.waitForSelector("#panel-identities .verdict");
  await page.click("#tab-motion");
  await step("0.0000000001");
  await summary("^running…$");
  await page.setInputFiles("#file", { name: "broken.urdf", mimeType: "application/xml", buffer: Buffer.from("<robot>") });
  await page.waitForFunction(() => /cannot be read as a robot/.test(document.querySelector("#status").textContent));
  await step("0.01");
  await summary("^rkmk4; 1,000 steps");
  // An invalid length is an error.
  await page.fill("#until", "-5");
  await page.press("#until", "Enter");
  await summary("the length of a run has to be a number greater than zero");
  await page.fill("#until", "2");
  await step("0");
  await summary("a step has to be a number greater than zero");
  await step("");
  await summary("^rkmk4; 2,000 steps");
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
  // Work of the page for a frame, without that of the renderer, which is software here.
  const { frame, calls } = await page.evaluate(() => globalThis.hamelMotion.measure(200));
  console.log(`Solo12: ${frame.toFixed(2)} ms of work for a frame, ${calls} calls of the graphics card`);
  assert.ok(frame < 1000 / 60, `${frame} ms`);
  assert.ok(calls < 300, `${calls} calls`);
  await picture(page, "solo12");
  assert.deepEqual(left, []);
  await close();
});

// Two bars that meet in a loop, far from any frame or body.
const BARS = `pub system Bars {
    joint a: revolute [0, 1, 0] moves left;
    joint b: revolute [0, 1, 0] at [1, 0, 0] moves right;
    body on left { mass 1; com [0, 0, 0.2]; inertia diag(0.02, 0.02, 0.02) about com; }
    body on right { mass 1; com [0, 0, 0.2]; inertia diag(0.02, 0.02, 0.02) about com; }
    joint c: revolute [0, 1, 0] on left at [0, 0, 0.8] moves top;
    body on top { mass 1; com [0.3, 0, 0]; inertia diag(0.02, 0.02, 0.02) about com; }
    loop position(top, [1, 0, 0])[1] = position(right, [0, 0, 0.8])[1];
    loop position(top, [1, 0, 0])[3] = position(right, [0, 0, 0.8])[3];
    gravity [0, 0, -9.81];
    start a = 0.2, b ~ 0.2, c ~ -0.2;
}`;

test("points of loops are drawn where they meet, and what has no place is named", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  await typed(page, BARS);
  await shown(page);
  const scene = await page.evaluate(() => globalThis.hamelMotion.run.scene);
  assert.equal(scene.loops.length, 1);
  const [one, other] = scene.loops[0];
  assert.ok(Math.hypot(...one.map((entry, k) => entry - other[k])) < 1e-9);
  const place = (point) => page.evaluate((point) => globalThis.hamelMotion.place(point), point);
  assert.ok((await red(page, await place(one))) > 10);
  assert.equal(await red(page, await place([one[0], one[1], one[2] + 0.3])), 0);
  assert.equal(await page.textContent("#missing"), "");
  // Inertia given by an energy has no place.
  await typed(page, "pub system Abstract { coord q; velocity w; rate q = w; kinetic w^2 / 2; potential q^2 / 2; start q = 1; }");
  await shown(page);
  const missing = await page.textContent("#missing");
  assert.match(missing, /nothing to draw.*`kinetic` has no place/);
  assert.equal(await page.isVisible(".stage"), false);
  assert.deepEqual(left, []);
  await close();
});

test("a body that is dragged at the start stays where it was put", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  // The bars in a loop have one degree of freedom, so a dragged point comes only as near as its path allows.
  for (const [text, [right, down], near] of [
    [await gallery("double_pendulum"), [-14, 10], 1],
    [BARS, [14, 3], 10],
  ]) {
    await typed(page, text);
    await shown(page);
    const found = () =>
      page.evaluate(() => {
        const { scene } = globalThis.hamelMotion.run;
        return globalThis.hamelMotion.place(scene.bodies[scene.bodies.length - 1].centre);
      });
    const fields = () => page.$$eval(".start input", (list) => list.map((one) => one.value));
    const before = await fields();
    await page.locator(".stage").scrollIntoViewIfNeeded();
    const [x, y] = await found();
    // A few pixels, which the bars in a loop can follow.
    const to = [x + right, y + down];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + right / 2, y + down / 2, { steps: 4 });
    await page.mouse.move(...to, { steps: 4 });
    await page.mouse.up();
    await page.waitForFunction((before) => [...document.querySelectorAll(".start input")].some((one, k) => one.value !== before[k]), before);
    await page.waitForFunction(
      ([x, y]) => {
        const { scene } = globalThis.hamelMotion.run;
        const [a, b] = globalThis.hamelMotion.place(scene.bodies[scene.bodies.length - 1].centre);
        return Math.hypot(a - x, b - y) > 5;
      },
      [x, y],
    );
    const [a, b] = await found();
    assert.ok(Math.hypot(a - to[0], b - to[1]) < near, `${[x, y]} was dragged to ${to}, and is at ${[a, b]}`);
    assert.doesNotMatch(await page.getAttribute("#summary", "class"), /bad/);
    // Loops are closed, and the energy is constant.
    assert.ok(Number(await page.getAttribute("#summary", "data-drift")) < 1e-6);
    await page.click("#reset");
    await page.waitForFunction((before) => [...document.querySelectorAll(".start input")].every((one, k) => one.value === before[k]), before);
  }
  await picture(page, "dragged");
  assert.deepEqual(left, []);
  await close();
});

test("a name that is dragged sideways changes its number", async () => {
  const { page, left, close } = await opened();
  await answered(page);
  await shown(page);
  // By 0.01 for each pixel.
  const handle = page.locator(".start .handle").first();
  const input = page.locator(".start input").first();
  await handle.scrollIntoViewIfNeeded();
  const [box, number] = [await handle.boundingBox(), Number(await input.inputValue())];
  await page.mouse.move(box.x + 4, box.y + 4);
  await page.mouse.down();
  await page.mouse.move(box.x + 14, box.y + 4);
  await page.mouse.up();
  assert.ok(Math.abs(Number(await input.inputValue()) - number - 0.1) < 1e-9);
  assert.deepEqual(left, []);
  await close();
});
