// SPDX-License-Identifier: Zlib
//
// node browse.mjs <chromium> <page>...
//
// Opens pages in headless Chromium, with JavaScript on and off, and tells as JSON, page by page, what
// was drawn, what went wrong, what can be read, and how it prints.

import { Browser, scheme } from "./browser.mjs";

// What there is to see once all charts are drawn.
const charts = `(async () => {
    while (document.documentElement.dataset.charts !== "done") {
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
    return [...document.querySelectorAll("figure")].map((figure) => {
        const svg = figure.querySelector(".drawing svg");
        const all = (selector) => [...(svg?.querySelectorAll(selector) ?? [])];
        const names = all(".role-legend-label text");
        return {
            name: figure.id,
            drawn: figure.dataset.drawn,
            points: svg?.querySelectorAll(".mark-symbol.role-mark path").length,
            bars: svg?.querySelectorAll(".mark-rect.role-mark path").length,
            lines: svg?.querySelectorAll(".mark-line.role-mark path").length,
            texts: all("text").map((each) => each.textContent),
            series: all(".role-legend-symbol path").map((symbol, i) => [
                names[i].textContent, getComputedStyle(symbol).fill + symbol.getAttribute("d").replace(/[-\\d.]/g, ""),
            ]),
            broken: svg?.outerHTML.match(/NaN|Infinity|undefined/g)?.length ?? 0,
        };
    });
})()`;

const ink = `getComputedStyle(document.querySelector(".drawing svg text") ?? document.body).fill`;

const firstPoint = `(() => {
    const point = document.querySelector(".drawing .mark-symbol.role-mark path, .drawing .mark-rect.role-mark path");
    point?.scrollIntoView({ block: "center" });
    const { x = 0, y = 0, width = 0, height = 0 } = point?.getBoundingClientRect() ?? {};
    return { x: x + width / 2, y: y + height / 2 };
})()`;

const tooltip = `document.querySelector("#vg-tooltip-element.visible")?.textContent ?? ""`;

// A script that the page did not bring along, as an attacker's data would be.
const runForeignScript = `(() => {
    const script = document.createElement("script");
    script.textContent = "window.foreignScriptRan = true";
    document.body.append(script);
    return window.foreignScriptRan === true;
})()`;

const withoutScripts = `({
    rows: document.querySelectorAll("tbody tr").length,
    drawings: document.querySelectorAll("svg").length,
    notice: document.querySelector("noscript p")?.innerText,
})`;

async function print(tab) {
    const { data } = await tab("Page.printToPDF");
    return { begin: data && Buffer.from(data, "base64").toString("latin1", 0, 4), bytes: data.length };
}

async function withJavaScript({ tab, evaluate }) {
    const seen = { charts: await evaluate(charts), inks: [] };
    for (const name of ["light", "dark"]) {
        await scheme(tab, name);
        seen.inks.push(await evaluate(ink));
    }
    await evaluate(`document.querySelectorAll("details").forEach((fold) => (fold.open = true))`);
    await tab("Input.dispatchMouseEvent", { type: "mouseMoved", ...(await evaluate(firstPoint)) });
    seen.tooltip = await evaluate(tooltip);
    seen.pdf = await print(tab);
    seen.foreignScriptRan = await evaluate(runForeignScript);
    return seen;
}

async function withoutJavaScript({ tab, evaluate }) {
    return { ...(await evaluate(withoutScripts)), pdf: await print(tab) };
}

const [chromium, ...pages] = process.argv.slice(2);
const browser = new Browser(chromium, ["--disable-gpu"], 120);
const seen = [];
for (const page of pages) {
    seen.push({
        withJavaScript: await browser.inTab(page, {}, withJavaScript),
        withoutJavaScript: await browser.inTab(page, { javaScript: false }, withoutJavaScript),
    });
}
console.log(JSON.stringify(seen, null, 1));
await browser.close();
