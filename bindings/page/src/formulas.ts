// Formulas, set by KaTeX. Those that would fill the page are set when somebody asks for them.

import katex from "katex";
import { element } from "./dom";

// Letters of LaTeX beyond which a formula is a wall.
const LONG = 1500;

export function formula(latex: string): HTMLElement {
  if (latex.length <= LONG) {
    return set(latex);
  }
  const button = element("button", { class: "long", type: "button" }, `a formula of ${latex.length.toLocaleString("en")} letters: show it`);
  button.onclick = () => button.replaceWith(set(latex));
  return button;
}

// Formulas that were set already: most of them stay when somebody types. The oldest go first.
const known = new Map<string, HTMLElement>();
const KEPT = 3000;

function set(latex: string): HTMLElement {
  let span = known.get(latex);
  if (span === undefined) {
    span = element("span", { class: "formula" });
    katex.render(latex, span, { throwOnError: false, strict: "ignore" });
    known.set(latex, span);
    if (known.size > KEPT) {
      known.delete(known.keys().next().value ?? "");
    }
  }
  return span.cloneNode(true) as HTMLElement;
}
