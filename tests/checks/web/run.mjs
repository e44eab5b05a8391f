// SPDX-License-Identifier: Zlib
//
// Usage: node --single-threaded run.mjs PROGRAM [ARGUMENT...]
//
// Runs a WebAssembly program of WASI, which sees all files. With threads, Node.js 20 crashes when a large program
// has ended.

import { readFile } from "node:fs/promises";
import { WASI } from "node:wasi";

const [program, ...rest] = process.argv.slice(2);
const wasi = new WASI({
    version: "preview1",
    args: [program, ...rest],
    env: process.env,
    preopens: { "/": "/" },
});
const { instance } = await WebAssembly.instantiate(await readFile(program), {
    wasi_snapshot_preview1: wasi.wasiImport,
});
process.exitCode = wasi.start(instance);
