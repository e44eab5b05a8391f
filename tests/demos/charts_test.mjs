// SPDX-License-Identifier: Zlib
//
// node charts_test.mjs <folder of the packages>
//
// What charts.js makes of declared charts; browser_test.cpp sees them drawn.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { runInThisContext } from "node:vm";
import { ownScripts, vegaScripts } from "../../demos/report/chart_files.mjs";

const [packages] = process.argv.slice(2);
for (const script of [...vegaScripts(packages), ...ownScripts()]) {
    runInThisContext(script);
}
const { vega, vegaLite, axisOf, chartSpec, fixedLook, labelPlaces, linesOf, logTicks, looksOf } = globalThis;

// The colours of series, of page.css.
const palettes = (() => {
    const style = readFileSync(new URL("../../demos/report/page.css", import.meta.url), "utf8");
    const all = [...style.matchAll(/--series-\d: (#\w{6})/g)].map(([, colour]) => colour);
    return { light: all.slice(0, all.length / 2), dark: all.slice(all.length / 2) };
})();

const chartOf = (declared, columns, rows) =>
    ({
        title: "t", mark: "point", ...declared,
        data: { columns: columns.map((name) => ({ name, title: "", digits: name === "ms" ? 3 : 4 })), rows },
    });
const yChart = (y, ...ys) => chartOf({ x: "x", y }, ["x", "y"], ys.map((value, i) => [i + 1, value]));
const ofSeries = (...names) =>
    chartOf({ x: "x", y: "x", series: "m" }, ["x", "m"], names.map((name) => [1, name]));

/// The rows of some layers as they are drawn, by the channels of what is drawn.
async function drawn(chart, ...layers) {
    const spec = chartSpec(chart, looksOf([chart]));
    const only = { ...spec, layer: layers.map((layer) => spec.layer[layer]) };
    const view = new vega.View(vega.parse(vegaLite.compile(only).spec), { renderer: "none" });
    await view.runAsync();
    const marks = (item) => (item.marktype && item.marktype !== "group" && item.role === "mark" ? [item] : [])
        .concat((item.items ?? []).flatMap(marks));
    return marks(view.scenegraph().root).flatMap((mark) => mark.items);
}

test("Ticks are decades, and fewer of them where they are many", () => {
    assert.deepEqual(logTicks(0.005, 700), [0.01, 0.1, 1, 10, 100]);
    for (let low = -12; low < 12; ++low) {
        for (let high = low + 3; high <= 12; ++high) {
            const ticks = logTicks(10 ** low, 10 ** high);
            assert(ticks.length >= 3 && ticks.length <= 10, ticks);
        }
    }
});

test("Ticks are round numbers within a decade", () => {
    assert.deepEqual(logTicks(0.9, 30), [1, 2, 5, 10, 20]);
    assert.deepEqual(logTicks(2.05, 2.95), [2.2, 2.4, 2.6, 2.8]);
    assert.deepEqual(logTicks(3, 3), [3]);
});

test("Zero is apart below the smallest number, and labelled so", async () => {
    const chart = yChart("y log0", 0, 0.01, 1);
    const { shareOf, channel } = axisOf(chart, chart.y);
    assert(shareOf(0) === 0 && shareOf(0.01) > 0.1 && shareOf(0.01) < 0.15, shareOf(0.01));
    assert.equal(shareOf(1), 1);
    assert.match(channel.axis.labelExpr, /^datum.value < 0.01 \? '0'/);
    const [zero, hundredth, one] = (await drawn(chart, 0)).map((point) => point.y);
    assert(zero > hundredth + 20 && hundredth > one, [zero, hundredth, one]);
});

test("An axis has no place for zero where there is none", () => {
    const chart = yChart("y log0", 0.5, 1);
    assert.equal(axisOf(chart, chart.y).begin, 0.5);
});

test("An axis is straight, and has zero at its end, where all is zero or nothing", () => {
    for (const values of [[0, 0], [null, null]]) {
        const chart = yChart("y log0", ...values);
        assert.deepEqual(axisOf(chart, chart.y).channel.scale, { domain: [0, 1] });
    }
});

test("Only a logarithmic axis says so in its title", () => {
    const chart = chartOf({ x: "x", y: "y log" }, ["x", "y"], [[1, 1], [2, 10]]);
    const { x, y } = chartSpec(chart, new Map()).encoding;
    assert.deepEqual([x.title.join(" "), y.title.join(" ")], ["x", "y, log scale"]);
});

test("What a logarithm does not reach, and nothing, is not drawn", async () => {
    assert.equal((await drawn(yChart("y log", 0, 5, null, 6, -1), 0)).length, 2);
});

test("Bars begin at zero, and those of zero have no length", async () => {
    const some = { ...yChart("y", 0, 5), mark: "bar", x: "x names" };
    assert.deepEqual((await drawn(some, 0)).map(({ x, width }) => [x, width > 0]), [[0, false], [0, true]]);
    const none = { ...yChart("y", 0, 0), mark: "bar", x: "x names" };
    assert.deepEqual((await drawn(none, 0)).map(({ x, width }) => [x, width]), [[0, 0], [0, 0]]);
});

test("Points with names lie in rows of their own, those of a name side by side, each on its error", async () => {
    const names = ["a", "b"].map((letter) => letter.repeat(60));
    const chart = chartOf({ x: "x names", y: "y log", series: "m", low: "l", high: "h" }, ["x", "m", "y", "l", "h"],
        names.flatMap((name) => [[name, "p", 2, 1, 4], [name, "q", 8, 4, 16]]));
    const [rules, points] = [await drawn(chart, 0), await drawn(chart, 1)];
    assert.equal(new Set(points.map(({ y }) => y)).size, 4);
    for (const [i, { x, y }] of points.entries()) {
        assert.equal(rules[i].y, y);
        assert(Math.min(rules[i].x, rules[i].x2) < x && x < Math.max(rules[i].x, rules[i].x2), [rules[i].x, x]);
    }
});

test("The front holds the points that no other beats in both", async () => {
    const rows = [[3, 1], [1, 9], [2, 4], [4, 1], [2, 5], [5, null]];
    const chart = chartOf({ x: "x", y: "y", front: "true" }, ["x", "y"], rows);
    const front = (await drawn(chart, 0)).map(({ datum }) => [datum.x, datum.y]);
    assert.deepEqual(front, [[1, 9], [2, 4], [3, 1]]);
});

test("Series that share a theory have one line of it, others one each", async () => {
    const theories = (second) => chartOf({ mark: "line", x: "x", y: "y", series: "m", theory: "t" }, ["x", "y", "m", "t"],
        [[1, 1, "a", 1], [2, 1, "a", 2], [1, 1, "b", 1], [2, 1, "b", second]]);
    const colours = async (chart) => new Set((await drawn(chart, 1)).map(({ stroke }) => stroke)).size;
    assert.equal(await colours(theories(2)), 1);
    assert.equal(await colours(theories(3)), 2);
});

test("Lines go through the points in the order of the rows", async () => {
    const chart = chartOf({ mark: "line", x: "x", y: "y" }, ["x", "y"], [[2, 1], [1, 2], [3, 3]]);
    assert.deepEqual((await drawn(chart, 0)).map(({ datum }) => datum.x), [2, 1, 3]);
});

test("Numbers that name rows of cells grow upwards", () => {
    const chart = chartOf({ mark: "cell", x: "x names", y: "y names", shade: "z log" }, ["x", "y", "z"],
        [["a", 1000, 3], ["a", 20000, 4]]);
    assert.deepEqual(chartSpec(chart, new Map()).encoding.y.sort, ["20,000", "1,000"]);
});

test("Labels keep apart from each other and from the sides", () => {
    const at = (x, label) => ({ x, y: 100, label });
    const points = [at(100, "label"), at(100, "label"), at(100, "label"), at(658, "at the side")];
    const places = labelPlaces(points, 660);
    assert.equal(new Set(places.slice(0, 3).map(String)).size, 3);
    assert.equal(places[3][0], "right");
});

test("A point has no label where that would hide others", () => {
    const places = labelPlaces(Array.from({ length: 20 }, () => ({ x: 100, y: 100, label: "a label" })), 660);
    assert(places.some((place) => place === undefined), "there are eight places");
    assert(places[0] !== undefined);
});

test("Texts break into lines between words, and lose none", () => {
    assert.deepEqual(linesOf("a bb ccc", 4), ["a bb", "ccc"]);
    assert.deepEqual(linesOf("a longestword b", 4), ["a", "longestword", "b"]);
});

test("A chart has the width that it is given, and names in more lines in less of it", async () => {
    const name = "a name of many words for something";
    const chart = chartOf({ mark: "bar", x: "x names", y: "y" }, ["x", "y"], ["a", "b"].map((each) => [each + name, 1]));
    for (const [width, lines] of [[900, 1], [360, 3]]) {
        const spec = chartSpec(chart, looksOf([chart]), width);
        const view = new vega.View(vega.parse(vegaLite.compile(spec).spec), { renderer: "none" });
        const svg = await view.toSVG();
        assert.match(svg, new RegExp(`width="${width}"`));
        assert.equal(spec.data.values[0].x.split("\n").length, lines);
    }
});

test("Series look the same in all charts and differ within one", () => {
    const names = Array.from({ length: 40 }, (_, i) => `method ${i}`);
    const all = [names.slice(0, 7), names.slice(6, 13), names.slice(13)].map((some) => ofSeries(...some));
    const looks = looksOf(all);
    assert.equal(looks.size, 40);
    const different = (chart, ...keys) =>
        new Set(chart.data.rows.map(([, name]) => keys.map((key) => looks.get(name)[key]).join())).size;
    assert.equal(different(all[0], "colour"), 7);
    assert.equal(different(all[1], "colour"), 7);
    assert.equal(different(all[2], "colour", "shape"), 27);
});

test("Series of one colour in a chart differ in shape, however many others there are", () => {
    const looks = looksOf([ofSeries("p, 1", ..."12345".split("").map((i) => `q, ${i}`), "p, 2")]);
    assert.equal(looks.get("p, 1").colour, looks.get("p, 2").colour);
    assert.notEqual(looks.get("p, 1").shape, looks.get("p, 2").shape);
});

test("All variants of a method have its colour, and dashes and shapes of their own", () => {
    const variants = ["hash, cells of 5 m", "hash, cells of 100 m", "hash, automatic"];
    const looks = looksOf([
        ofSeries("un-optimized", "grid, cells of 5 m", "grid, cells of 100 m", ...variants),
        ofSeries("grid", "hash"),
    ]);
    const of = (key, ...names) => new Set(names.map((name) => looks.get(name)[key]));
    const methods = [["un-optimized"], ["grid", "grid, cells of 5 m", "grid, cells of 100 m"], ["hash", ...variants]];
    for (const series of methods) {
        assert.equal(of("colour", ...series).size, 1, series[0]);
        assert.equal(of("dash", ...series).size, series.length, series[0]);
    }
    assert.equal(of("colour", ...methods.map(([first]) => first)).size, 3);
    assert.equal(of("shape", ...variants).size, 3);
});

test("Points without a place have no label", async () => {
    const rows = [[0, 1, "a"], [1, 0, "b"], [-1, 1, "c"], [1, null, "d"], [1, 1, null], [2, 2, "e"]];
    const chart = chartOf({ x: "x log", y: "y log", label: "l" }, ["x", "y", "l"], rows);
    assert.deepEqual((await drawn(chart, 1)).map(({ text }) => text), ["e"]);
    assert.deepEqual((await drawn({ ...chart, x: "x log0" }, 1)).map(({ text }) => text), ["a", "e"]);
    const numbers = { ...chart, data: { ...chart.data, rows: [[1, 1, 0.25], [9, 9, 4000]] } };
    assert.deepEqual((await drawn(numbers, 1)).map(({ text }) => text), ["0.25", "4,000"]);
});

test("Errors reach from low to high, on logarithmic axes too", async () => {
    const chart = chartOf({ mark: "line", x: "x", y: "y log", low: "l", high: "h" }, ["x", "y", "l", "h"],
        [[1, 2, 1, 4], [2, 8, 4, 16]]);
    const rules = await drawn(chart, 1);
    const heights = rules.map(({ y, y2 }) => Math.abs(y2 - y));
    assert(heights.length === 2 && heights[0] > 20 && Math.abs(heights[0] - heights[1]) < 1e-6, heights);
});

test("Bars whose names are long lie, each with its error", async () => {
    const names = "abcd".split("").map((letter) => letter.repeat(40));
    const chart = chartOf({ mark: "bar", x: "x names", y: "y", low: "l", high: "h" }, ["x", "y", "l", "h"],
        names.map((name, i) => [name, i + 1, i, i + 2]));
    const [bars, rules] = [await drawn(chart, 0), await drawn(chart, 1)];
    assert(bars.length === 4 && bars.every(({ width, height }) => width > height), "bars");
    assert(rules.length === 4 && rules.every(({ x, x2, y, y2 }) => x !== x2 && (y2 ?? y) === y), "rules");
});

test("Cells say what is in them, in ink that can be read", async () => {
    const chart = chartOf({ mark: "cell", x: "x names", y: "y names", shade: "z log" }, ["x", "y", "z"],
        [["a", "c", 1], ["b", "c", 1234], ["a", "d", null]]);
    const texts = (await drawn(chart, 0, 1)).filter(({ text }) => text);
    assert.deepEqual(texts.map(({ text }) => text), ["1", "1,234"]);
    assert.deepEqual(texts.map(({ fill }) => fill), ["#ffffff", "#000000"]);
});

test("What is drawn into files has titles, all rows, and colours of its own", () => {
    const folder = mkdtempSync(join(tmpdir(), "charts-"));
    try {
        const chart = chartOf({ mark: "line", x: "x", y: "y", series: "m" }, ["x", "y", "m"],
            [[1, 1, "btDbvtBroadphase"], [2, 2, "btDbvtBroadphase"], [1, 3, "hash"]]);
        const charts = [{ ...chart, name: "one", title: "The title", settings: "the settings" }];
        writeFileSync(join(folder, "found.json"), JSON.stringify({ charts }));
        execFileSync(process.execPath, [fileURLToPath(new URL("../../demos/report/draw_charts.mjs", import.meta.url)),
            packages, folder]);
        const [spec, svg] = ["one.vl.json", "one.svg"].map((name) => readFileSync(join(folder, name), "utf8"));
        const { title, data } = JSON.parse(spec);
        assert.deepEqual([title, data.values.length], [{ text: ["The title"], subtitle: ["the settings"] }, 3]);
        for (const text of [spec, svg]) {
            assert.doesNotMatch(text, /var\(|undefined|NaN/);
            for (const name of ["btDbvtBroadphase", "hash"]) {
                assert(text.includes(palettes.light[fixedLook(name).colour]), `${name} as on pages`);
            }
        }
        assert.match(svg, /The title.*the settings/s);
    } finally {
        rmSync(folder, { recursive: true });
    }
});

test("Methods look the same whatever else a page shows, and as in the table", () => {
    const one = looksOf([ofSeries("btDbvtBroadphase", "hashphase", "other")]);
    const two = looksOf([ofSeries("another", "bt32BitAxisSweep3", "more"), ofSeries("hashphase", "btDbvtBroadphase")]);
    for (const name of ["hashphase", "btDbvtBroadphase"]) {
        assert.deepEqual(one.get(name), two.get(name));
        assert.equal(one.get(name).colour, fixedLook(name).colour);
    }
    assert.equal(fixedLook("hash").colour, fixedLook("hashphase, automatic cells").colour);
    assert.equal(fixedLook("something else"), undefined);
});

// Machado, Oliveira and Fernandes, "A Physiologically-based Model for Simulation of Color Vision Deficiency", 2009:
// what people see who lack a kind of cone, of linear RGB.
const VISIONS = {
    all: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    protanopia: [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    deuteranopia: [[0.367, 0.861, -0.228], [0.28, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    tritanopia: [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.147], [0.005, 0.691, 0.304]],
};

// CIE L*a*b* of a colour, in which a distance of 2.3 is just noticed.
function labOf(hex, vision) {
    const linear = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255)
        .map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
    const [r, g, b] = vision.map((row) => Math.min(1, Math.max(0, row.reduce((sum, of, i) => sum + of * linear[i], 0))));
    const [x, y, z] = [
        (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
    ].map((value) => (value > 0.008856 ? Math.cbrt(value) : 7.787 * value + 16 / 116));
    return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

test("Colours of methods differ for people of any colour vision, on light and dark screens", () => {
    for (const [screen, colours] of Object.entries(palettes)) {
        assert.equal(colours.length, 7);
        for (const [name, vision] of Object.entries(VISIONS)) {
            const seen = colours.map((colour) => labOf(colour, vision));
            for (const [i, one] of seen.entries()) {
                for (const [j, other] of seen.slice(0, i).entries()) {
                    const distance = Math.hypot(...one.map((value, axis) => value - other[axis]));
                    assert(distance > 13, `${j} and ${i}, ${screen}, ${name}: ${distance}`);
                }
            }
        }
    }
});

test("Broadphases differ in shape as well", () => {
    const names = ["hash", "dbvt", "dbvt-deferred", "axis-sweep", "simple"];
    const looks = names.map(fixedLook);
    assert.equal(new Set(looks.map(({ shape }) => shape)).size, names.length);
    assert.equal(new Set(looks.map(({ colour }) => colour)).size, names.length);
    const titles = ["hashphase", "btDbvtBroadphase", "btDbvtBroadphase, deferred", "bt32BitAxisSweep3",
        "btSimpleBroadphase"];
    assert.deepEqual(titles.map(fixedLook), looks, "by either name");
});

test("Columns that Vega would read as paths are columns", async () => {
    const chart = chartOf({ x: "x", y: "x", series: "method.of[x]" }, ["x", "method.of[x]"], [[1, "m"], [2, "n"]]);
    const [one, other] = await drawn(chart, 0);
    assert.deepEqual(one.tooltip, { x: "1", "method.of[x]": "m" });
    assert.deepEqual([one.fill, other.fill], ["var(--series-0)", "var(--series-1)"]);
});

test("Numbers in cells and beside points have the digits that are declared", async () => {
    const cells = (value) =>
        chartOf({ x: "x names", y: "y names", shade: value, mark: "cell" }, ["x", "y", value], [["a", "b", 12.3456]]);
    assert.deepEqual((await drawn(cells("n"), 1)).map(({ text }) => text), ["12.35"]);
    assert.deepEqual((await drawn(cells("ms"), 1)).map(({ text }) => text), ["12.3"]);
    const points = chartOf({ x: "x", y: "ms" }, ["x", "ms"], [[1, 1]]);
    const { tooltip } = chartSpec(points, looksOf([points])).layer.at(-1).encoding;
    assert.deepEqual(tooltip.map(({ format }) => format), [",.4~g", ",.3~g"]);
});
