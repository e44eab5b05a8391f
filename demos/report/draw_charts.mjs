// SPDX-License-Identifier: Zlib
//
// node draw_charts.mjs <folder of the packages> <folder>
//
// Draws the charts that any .json of the folder holds: <name>.vl.json, as Vega-Lite draws it, and <name>.svg.

import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { runInThisContext } from "node:vm";

const [packages, folder] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const read = (...path) => readFileSync(join(...path), "utf8");
for (const script of [
    [packages, "vega/build/vega.min.js"],
    [packages, "vega-lite/build/vega-lite.min.js"],
    [here, "charts.js"],
]) {
    runInThisContext(read(...script));
}
const { vega, vegaLite, chartSpec, looksOf } = globalThis;

// The page's colours on a light screen.
const colours = new Map(
    [...read(here, "page.css").matchAll(/(--[\w-]+): (#\w+)/g)].map(([, name, colour]) => [name, colour]).reverse(),
);

// As many lines as the letters need.
const lines = (text, width) => text.match(new RegExp(`\\S.{0,${width - 1}}(?=\\s|$)`, "g"));

const charts = readdirSync(folder)
    .filter((name) => name.endsWith(".json") && !name.endsWith(".vl.json"))
    .sort((a, b) => a.localeCompare(b, "en", { numeric: true }))
    .flatMap((name) => JSON.parse(read(folder, name)).charts ?? []);
if (charts.length === 0) {
    console.error(`No .json in ${folder} holds charts.`);
    process.exit(2);
}
const looks = looksOf(charts);
for (const chart of charts) {
    const { config, ...drawn } = chartSpec(chart, looks);
    const titled = {
        title: { text: lines(chart.title, 84), subtitle: lines(chart.settings, 105) },
        ...drawn,
        config: { ...config, background: "var(--paper)", padding: 14 },
    };
    const text = JSON.stringify(titled, null, 1).replace(/var\((--[\w-]+)\)/g, (_, name) => colours.get(name));
    const view = new vega.View(vega.parse(vegaLite.compile(JSON.parse(text)).spec), { renderer: "none" });
    writeFileSync(join(folder, `${chart.name}.vl.json`), text + "\n");
    writeFileSync(join(folder, `${chart.name}.svg`), (await view.toSVG()) + "\n");
    console.log(join(folder, `${chart.name}.svg`));
}
