// SPDX-License-Identifier: Zlib
//
// node bundle_charts.mjs <folder of the packages> <C++ file>
//
// Writes the scripts that draw charts as one string into a C++ source (chart_scripts.hpp), together
// with the hash by which a content-security policy admits exactly them.

import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { ownScripts, vegaScripts } from "./chart_files.mjs";

const [packages, output] = process.argv.slice(2);
const code = [
    ...vegaScripts(packages),
    readFileSync(join(packages, "vega-embed/build/vega-embed.min.js"), "utf8"),
    ...ownScripts(),
    readFileSync(new URL("page.js", import.meta.url), "utf8"),
]
    .join("\n")
    .replace(/^\/\/# sourceMappingURL=.*$/gm, "")
    .replace(/\r/g, "")
    // Within a page, these would end the script or hide what follows.
    .replace(/<(?=\/script|!--)/gi, "\\x3c");

const end = ')charts"';
if (code.includes(end)) {
    throw new Error(`The scripts contain ${end}, which ends a raw string.`);
}
const hash = "sha256-" + createHash("sha256").update(code).digest("base64");
writeFileSync(
    output,
    `#include <demos/report/chart_scripts.hpp>

namespace hashphase::demos {

ChartScripts chartScripts() {
    return {R"charts(${code})charts", "${hash}", {}};
}

}  // namespace hashphase::demos
`,
);
