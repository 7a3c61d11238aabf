// Formulas, typeset by KaTeX. Very long ones are typeset on request.

import katex from "katex";
import { element } from "./dom";

// Number of characters of LaTeX above which a formula is typeset on request.
const LONG = 1500;

export function formula(latex: string): HTMLElement {
  if (latex.length <= LONG) {
    return set(latex);
  }
  const button = element("button", { class: "long", type: "button" }, `show a formula of ${latex.length.toLocaleString("en")} characters`);
  button.onclick = () => button.replaceWith(set(latex));
  return button;
}

// Cache of typeset formulas, since most stay the same while the text is edited; the oldest are removed first.
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
