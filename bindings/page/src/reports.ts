// Panels of identities with their verdicts, operation counts with advice on velocities, and generated code.

import type { Advice, Checked, Counts, Operations } from "./answers";
import { element } from "./dom";

export function identities(checked: Checked): Node[] {
  const rows = checked.identities.map((identity) =>
    element(
      "tr",
      {},
      element("td", {}, identity.label),
      element("td", { class: "code" }, identity.equation),
      element("td", {}, element("span", { class: `verdict ${identity.verdict}` }, identity.verdict), identity.told === "" ? null : ` ${identity.told}`),
    ),
  );
  const head = ["equation", "identity", "verdict"].map((name) => element("th", { scope: "col" }, name));
  return [
    element(
      "p",
      { class: "note" },
      "“proved” means exact, over the rationals and modulo the constraint; “checked” means equality at random points of the configuration manifold in exact arithmetic, with a bound on the probability that a false equation passes.",
    ),
    element("div", { class: "scroll" }, element("table", { class: "grid" }, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows))),
    element("h3", {}, "Consequences of the coefficients"),
    element("pre", { tabindex: "0" }, checked.remarks.replace(/^ {2}/gm, "")),
  ];
}

const KINDS: (keyof Counts)[] = ["flops", "add", "mul", "div", "sqrt", "sincos", "other"];

export function operations(counted: Operations): Node[] {
  const head = ["function", ...KINDS, "written out"].map((name) => element("th", { scope: "col" }, name));
  const rows = Object.entries(counted.functions).map(([name, { shared, unshared }]) =>
    element(
      "tr",
      {},
      element("th", { scope: "row", class: "code" }, name),
      ...KINDS.map((kind) => element("td", { class: "number" }, String(shared[kind]))),
      element("td", { class: "number" }, unshared.flops == null ? "—" : compact(unshared.flops)),
    ),
  );
  const once = KINDS.slice(1).reduce((sum, kind) => sum + counted.parameters.hoisted[kind], 0);
  return [
    element("p", { class: "note" }, `Operations of one call. ${once} more are done once, when parameters are set. “written out” counts the same results without shared subexpressions.`),
    element("div", { class: "scroll" }, element("table", { class: "grid" }, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows))),
  ];
}

function compact(count: number): string {
  return count < 1e7 ? String(count) : count.toExponential(1);
}

export function advice(advised: Advice): Node[] {
  const head = ["velocities", "accel", "rate", "statements"].map((name) => element("th", { scope: "col" }, name));
  const rows = advised.choices.map((choice) =>
    element(
      "tr",
      {},
      element("th", { scope: "row" }, choice.velocities),
      element("td", { class: "number" }, String(choice.accel.flops)),
      element("td", { class: "number" }, String(choice.rate.flops)),
      choice.as_written === "yes" ? element("td", {}, "as written") : element("td", {}, element("pre", {}, choice.statements.join("\n"))),
    ),
  );
  return [element("div", { class: "scroll" }, element("table", { class: "grid" }, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows)))];
}

// Generated code with a button that copies it.
export function code(title: string, text: string): Node {
  const copy = element("button", { type: "button" }, "Copy");
  copy.onclick = async () => {
    await navigator.clipboard.writeText(text);
    copy.textContent = "Copied";
  };
  const lines = text.split("\n").length - 1;
  return element(
    "section",
    { class: "generated" },
    element("h3", {}, title, element("small", {}, `${lines.toLocaleString("en")} lines`), copy),
    element("pre", { tabindex: "0", class: "source" }, text),
  );
}
