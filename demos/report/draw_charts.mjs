// SPDX-License-Identifier: Zlib
//
// node draw_charts.mjs <folder of the packages> <folder>
//
// Draws every <name>.vl.json of the folder as <name>.svg.

import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { runInThisContext } from "node:vm";

const [packages, folder] = process.argv.slice(2);
for (const bundle of ["vega/build/vega.min.js", "vega-lite/build/vega-lite.min.js"]) {
    runInThisContext(readFileSync(join(packages, bundle), "utf8"));
}
const { vega, vegaLite } = globalThis;

const ending = ".vl.json";
const charts = readdirSync(folder).filter((name) => name.endsWith(ending));
if (charts.length === 0) {
    console.error(`There is no chart (*${ending}) in ${folder}.`);
    process.exit(2);
}
for (const name of charts) {
    const chart = JSON.parse(readFileSync(join(folder, name), "utf8"));
    const view = new vega.View(vega.parse(vegaLite.compile(chart).spec), { renderer: "none" });
    const picture = name.slice(0, -ending.length) + ".svg";
    writeFileSync(join(folder, picture), (await view.toSVG()) + "\n");
    console.log(join(folder, picture));
}
