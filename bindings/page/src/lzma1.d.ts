// What the page takes of the package `lzma1`, whose own types are sources that do not pass the settings of this page.

export function decompress(packed: Uint8Array): Uint8Array<ArrayBuffer>;
