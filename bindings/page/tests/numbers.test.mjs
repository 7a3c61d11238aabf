// The numbers of the page are those of the command line: all quantities at a state, and along a run.

import assert from "node:assert/strict";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { answered, asked, model, opened, said, stopped } from "./browser.mjs";

after(stopped);

// Rotations, circles, quaternions, loops, wheels that roll, states of first order, time, springs.
const MODELS = [
  "heavy_top",
  "free_body",
  "euler_top_quaternion",
  "double_pendulum_circles",
  "four_bar_loop",
  "bricard",
  "rolling_disk",
  "snakeboard",
  "lagging_drone",
  "kapitza",
];
// Relative tolerance: WebAssembly has no fused multiply-add, so results differ by rounding.
const NEAR = 1e-13;

// All leaves of a value, in order.
function flat(value) {
  return value !== null && typeof value === "object" ? Object.values(value).flatMap(flat) : [value];
}

function close(mine, theirs, about) {
  const [a, b] = [flat(mine), flat(theirs)];
  assert.equal(a.length, b.length, about);
  const scale = b.reduce((most, number) => (typeof number === "number" ? Math.max(most, Math.abs(number)) : most), 1);
  a.forEach((value, index) => {
    if (typeof value === "number" && typeof b[index] === "number") {
      const off = Math.abs(value - b[index]) / scale;
      assert.ok(off <= NEAR, `${about}, number ${index}: ${value} and ${b[index]}, ${off} of ${scale}`);
    } else {
      assert.equal(value, b[index], about);
    }
  });
  return a.length;
}

test("at a state and along a run, ten models have the numbers of the command line", async () => {
  const { page, left, close: closed } = await opened();
  await answered(page);
  const folder = await mkdtemp(join(tmpdir(), "hamel-page-"));
  let compared = 0;
  for (const name of MODELS) {
    const file = `tests/models/${name}.eom`;
    const answer = await asked(page, "open", { text: await model(name), name: `${name}.eom` });
    assert.notEqual(answer.system, null, answer.said);
    const mine = await asked(page, "evaluate");
    const evaluated = said(["eval", file]);
    assert.equal(evaluated.status, 0, evaluated.stderr);
    const theirs = JSON.parse(evaluated.stdout);
    assert.deepEqual(Object.keys(mine).sort(), Object.keys(theirs).sort());
    for (const key of Object.keys(theirs)) {
      compared += close(mine[key], theirs[key], `${name}, ${key}`);
    }

    const out = join(folder, `${name}.json`);
    const options = ["--until", "0.2", "--step", "0.01", "--method", "rkmk4", "--every", "1", "--out", out];
    const ran = said(["simulate", file, ...options]);
    assert.equal(ran.status, 0, ran.stderr);
    const samples = JSON.parse(await readFile(out, "utf8"));
    const run = await asked(page, "simulate", { until: 0.2, step: 0.01, method: "rkmk4" });
    assert.equal(run.failure, null);
    assert.equal(run.t.length, samples.length);
    const { coordinates, velocities } = answer.system;
    samples.forEach((sample, at) => {
      const entries = (names, all) => names.entries.map((entry, index) => [entry, all[at * names.entries.length + index]]);
      const state = Object.fromEntries([["t", run.t[at]], ...entries(coordinates, run.x), ...entries(velocities, run.xi)]);
      const same = Object.keys(state).map((entry) => sample[entry]);
      compared += close(Object.values(state), same, `${name} at ${sample.t}`);
    });
  }
  await rm(folder, { recursive: true });
  console.log(`${compared.toLocaleString("en")} numbers of ${MODELS.length} models compared`);
  assert.ok(compared > 5000);
  assert.deepEqual(left, []);
  await closed();
});
