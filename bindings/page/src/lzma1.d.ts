// Types of the function that the page uses from `lzma1`, whose own types fail the compiler settings of the page.

export function decompress(packed: Uint8Array): Uint8Array<ArrayBuffer>;
