// Syntax highlighting of descriptions: comments, statements, kinds, functions, numbers. It does not detect errors.

import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { tags } from "@lezer/highlight";

const words = (text: string) => new Set(text.split(" "));

const STATEMENTS = words(
  "system param const let fn table extern coord constraint velocity rate inactive nonholonomic independent loop for component " +
    "part include time prescribe frame body particle kinetic potential gravity state input force torque wrench generalized " +
    "spring damper dissipation start output generate invariant joint actuate",
);
const INSIDE = words(
  "on in from to at of with about along when if else mass com inertia origin stiffness length coefficient world stabilized " +
    "linear pchip extrapolate hold error jacobian all energy pub",
);
const KINDS = words("R1 R2 R3 R4 R5 R6 S1 S3 SO3 SE3 vec2 vec3 vec4 vec6 mat2 mat3 sym2 sym3");
const FUNCTIONS = words(
  "transpose dot cross outer hat vee norm diag trace identity sin cos tan asin acos atan atan2 sqrt exp log log1p expm1 sinh cosh tanh sign abs " +
    "min max clamp hypot pi pose rotx roty rotz rpy axis_angle rot position acceleration angular_velocity angular_acceleration " +
    "angle translation",
);

interface State {
  inComment: boolean;
}

const language = StreamLanguage.define<State>({
  name: "hamel",
  startState: () => ({ inComment: false }),
  token(stream, state) {
    if (state.inComment || stream.match("/*")) {
      state.inComment = !stream.match(/^.*?\*\//);
      if (state.inComment) {
        stream.skipToEnd();
      }
      return "comment";
    }
    if (stream.eatSpace()) {
      return null;
    }
    if (stream.match("///")) {
      stream.skipToEnd();
      return "docComment";
    }
    if (stream.match("//")) {
      stream.skipToEnd();
      return "comment";
    }
    if (stream.match(/^"[^"]*"?/)) {
      return "string";
    }
    if (stream.match(/^\d+(\.(?!\.)\d*)?([eE][+-]?\d+)?/)) {
      return "number";
    }
    const word = stream.match(/^[\p{L}_][\p{L}\p{N}_]*/u) as RegExpMatchArray | null;
    if (word !== null) {
      const name = word[0];
      if (STATEMENTS.has(name)) {
        return "keyword";
      }
      if (INSIDE.has(name)) {
        return "modifier";
      }
      if (KINDS.has(name)) {
        return "typeName";
      }
      return FUNCTIONS.has(name) ? "macroName" : "variableName";
    }
    stream.next();
    return "operator";
  },
  languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } } },
});

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--faint)" },
  { tag: tags.docComment, color: "var(--faint)", fontStyle: "italic" },
  { tag: tags.keyword, color: "var(--keyword)", fontWeight: "600" },
  { tag: tags.modifier, color: "var(--keyword)" },
  { tag: tags.typeName, color: "var(--type)" },
  { tag: tags.macroName, color: "var(--function)" },
  { tag: tags.number, color: "var(--number)" },
  { tag: tags.string, color: "var(--number)" },
]);

export const descriptions: Extension = [language, syntaxHighlighting(colours)];
