// Unpacks and runs the script of the page, which unpacks all other parts with the same function.

import { decompress } from "lzma1";

// Unpacks a part of the file, which is compressed and encoded in base64.
function part(id: string): Uint8Array<ArrayBuffer> {
  const text = document.getElementById(id)?.textContent ?? "";
  return decompress(Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0)));
}

Object.assign(globalThis, { hamelPart: part });
const script = document.createElement("script");
script.textContent = new TextDecoder().decode(part("page"));
document.body.append(script);
