// What runs first: it unpacks the page's script, which gets everything else by the same code.

import { decompress } from "lzma1";

// A part of the file: packed, in base64.
function part(id: string): Uint8Array<ArrayBuffer> {
  const text = document.getElementById(id)?.textContent ?? "";
  return decompress(Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0)));
}

Object.assign(globalThis, { hamelPart: part });
const script = document.createElement("script");
script.textContent = new TextDecoder().decode(part("page"));
document.body.append(script);
