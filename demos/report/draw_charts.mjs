// SPDX-License-Identifier: Zlib
//
// node draw_charts.mjs <folder of the packages> <folder>
//
// Draws the charts that any .json of the folder holds: <name>.vl.json, as Vega-Lite draws it, and <name>.svg.

import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { runInThisContext } from "node:vm";
import { ownScripts, vegaScripts } from "./chart_files.mjs";

const [packages, folder] = process.argv.slice(2);
const read = (path) => readFileSync(path, "utf8");
for (const script of [...vegaScripts(packages), ...ownScripts()]) {
    runInThisContext(script);
}
const { vega, vegaLite, chartSpec, linesOf, looksOf } = globalThis;

// The page's colours on a light screen.
const style = read(new URL("page.css", import.meta.url));
const colours = new Map(
    [...style.matchAll(/(--[\w-]+): (#\w+)/g)].map(([, name, colour]) => [name, colour]).reverse(),
);

const charts = readdirSync(folder)
    .filter((name) => name.endsWith(".json") && !name.endsWith(".vl.json"))
    .sort((a, b) => a.localeCompare(b, "en", { numeric: true }))
    .flatMap((name) => JSON.parse(read(join(folder, name))).charts ?? []);
if (charts.length === 0) {
    console.error(`No .json in ${folder} holds charts.`);
    process.exit(2);
}
const looks = looksOf(charts);
for (const chart of charts) {
    const { config, ...drawn } = chartSpec(chart, looks);
    const titled = {
        title: { text: linesOf(chart.title, 84), subtitle: linesOf(chart.settings, 105) },
        ...drawn,
        config: { ...config, background: "var(--paper)", padding: 14 },
    };
    const text = JSON.stringify(titled, null, 1).replace(/var\((--[\w-]+)\)/g, (_, name) => colours.get(name));
    const view = new vega.View(vega.parse(vegaLite.compile(JSON.parse(text)).spec), { renderer: "none" });
    writeFileSync(join(folder, `${chart.name}.vl.json`), text + "\n");
    writeFileSync(join(folder, `${chart.name}.svg`), (await view.toSVG()) + "\n");
    console.log(join(folder, `${chart.name}.svg`));
}
