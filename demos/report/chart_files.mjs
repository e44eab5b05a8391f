// SPDX-License-Identifier: Zlib
//
// The scripts that draw charts, in the order in which they are loaded: first those of packages.

import { readFileSync } from "node:fs";
import { join } from "node:path";

const read = (path) => readFileSync(path, "utf8");

export const vegaScripts = (packages) =>
    ["vega/build/vega.min.js", "vega-lite/build/vega-lite.min.js"].map((name) => read(join(packages, name)));

export const ownScripts = () =>
    ["method_looks.js", "chart_axes.js", "charts.js"].map((name) => read(new URL(name, import.meta.url)));
