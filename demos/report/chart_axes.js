// SPDX-License-Identifier: Zlib
//
// Axes of charts, and labels of points, as charts.js draws them.

const LETTER = 7; // [px], the width of one

const distinct = (values) => [...new Set(values)];

// Numbers as people read them, of which some name what is drawn.
const textOf = (value) =>
    typeof value !== "number" ? (value ?? "-")
    : Math.abs(value) >= 1000 ? Math.round(value).toLocaleString("en-US")
    : String(Number(value.toPrecision(4)));

const valuesOf = ({ data }, column) => {
    const at = data.columns.findIndex((each) => each.name === column);
    return data.rows.map((row) => row[at]);
};

const titleOf = ({ data }, column) => data.columns.find((each) => each.name === column).title || column;

// Significant digits of its numbers, as tables have them.
const digitsOf = ({ data }, column) => data.columns.find((each) => each.name === column).digits;

// Fields of Vega-Lite, which reads some letters as paths.
const fieldOf = (column) => column.replace(/\W/g, "_");
const placeOf = (column) => `at ${fieldOf(column)}`;

// The text in lines of at most so many letters; only a longer word makes a longer line.
function linesOf(text, letters) {
    const lines = [];
    for (const word of text.split(" ")) {
        if (lines.length > 0 && lines.at(-1).length + 1 + word.length <= letters) {
            lines.push(`${lines.pop()} ${word}`);
        } else {
            lines.push(word);
        }
    }
    return lines;
}

const longest = (texts) => Math.max(0, ...texts.map((text) => text.length));

// --- Axes -----------------------------------------------------------------------------------------

// Three to ten round numbers: decades where there are enough, else steps of 1, 2, 5, else even ones.
function logTicks(low, high) {
    const all = vega.scale("log")().domain([low, high]).ticks(6);
    const beginningWith = (digits) => all.filter((tick) => digits.test(tick.toExponential()));
    return [/^1e/, /^[125]e/].map(beginningWith).find((ticks) => ticks.length >= 3)
        ?? (low < high ? vega.scale("linear")().domain([low, high]).ticks(4) : [low]);
}

// "0.001", "50", "20k", "1e-7"
const TICK_LABEL = "format(datum.value, datum.value >= 10000 ? '~s' : datum.value < 0.0001 ? '~e' : '~g')";

// "missed log0": the column, its channel, where its numbers lie as shares of the axis, if anywhere, and which
// names it has. A logarithmic axis has 0, where log0 allows it, apart on a dotted line below the smallest
// number; its numbers and those of the other columns become places by `transform`. A linear one has 0.
function axisOf(chart, words, others = []) {
    const [column, kind = "linear"] = words.split(" ");
    const channel = { field: fieldOf(column), title: titleOf(chart, column) };
    if (kind === "names") {
        const names = distinct(valuesOf(chart, column).map(textOf));
        const axis = { grid: chart.mark === "point" };
        return { column, names, channel: { ...channel, type: "nominal", scale: { type: "band" }, axis } };
    }
    channel.type = "quantitative";
    const numbers = [column, ...others].flatMap((each) => valuesOf(chart, each)).filter(Number.isFinite);
    const positive = numbers.filter((number) => number > 0);
    if (kind === "linear" || positive.length === 0) {
        const domain = [Math.min(0, ...numbers), Math.max(0, ...numbers)];
        if (domain[0] === domain[1]) {
            channel.scale = { domain: [0, 1] }; // else zero would lie in the middle
        }
        return { column, channel, shareOf: vega.scale("linear")().domain(domain) };
    }
    const low = Math.min(...positive);
    const high = Math.max(...positive);
    const zero = kind === "log0" && numbers.includes(0) ? low * Math.max(high / low, 2) ** -0.12 : null;
    const axis = { values: logTicks(low, high), labelExpr: TICK_LABEL };
    if (zero !== null) {
        const isZero = `datum.value < ${low}`;
        axis.values.unshift(zero);
        axis.labelExpr = `${isZero} ? '0' : ${TICK_LABEL}`;
        axis.gridDash = { condition: { test: isZero, value: [1, 3] }, value: [] };
        axis.gridColor = { condition: { test: isZero, value: INK }, value: "var(--faint)" };
    }
    const domain = [zero ?? low, high];
    // What a logarithm does not reach has no place.
    const place = (field) =>
        `datum['${field}'] > 0 ? datum['${field}'] : datum['${field}'] === 0 ? ${zero} : null`;
    return {
        column,
        begin: domain[0],
        transform: [column, ...others].map((each) => ({ calculate: place(fieldOf(each)), as: placeOf(each) })),
        channel: {
            ...channel,
            title: `${channel.title}, log scale`,
            field: placeOf(column),
            scale: { type: "log", domain, nice: false, padding: 12 },
            axis,
        },
        shareOf: (number) => vega.scale("log")().domain(domain)(number > 0 ? number : number === 0 ? zero : null),
    };
}

// --- Labels of points -----------------------------------------------------------------------------

const PLACES = [
    ["left", 7, -7], ["right", -7, -7], ["left", 7, 8], ["right", -7, 8],
    ["center", 0, -12], ["center", 0, 13], ["left", 9, 0], ["right", -9, 0],
];

// Of eight places around a point the first in which its label hides neither points nor other labels and ends
// beyond no side: [align, dx, dy]. Undefined where there is none: the point has no label then.
function labelPlaces(points, chartWidth) {
    const overlap = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
    const far = 1e6;
    const taken = [[-far, -far, 0, far], [chartWidth, -far, far, far]]; // left, top, right, bottom
    taken.push(...points.map(({ x, y }) => [x - 4, y - 4, x + 4, y + 4]));
    return points.map(({ x, y, label }) => {
        const boxes = PLACES.map(([align, dx, dy]) => {
            const width = (LETTER - 1) * label.length;
            const left = x + dx - width * { left: 0, right: 1, center: 0.5 }[align];
            return [left, y + dy - 6, left + width, y + dy + 6];
        });
        const free = boxes.findIndex((box) => !taken.some((each) => overlap(box, each)));
        if (free >= 0) {
            taken.push(boxes[free]);
        }
        return PLACES[free];
    });
}

// Of a chart whose axes have these lengths.
function labelLayer(chart, x, y, rows, { across, up }) {
    const column = fieldOf(chart.label);
    const shareOn = (axis, row) => axis.shareOf(row[fieldOf(axis.column)]);
    const hasPlace = (row) => [x, y].every((axis) => Number.isFinite(shareOn(axis, row)));
    const labelled = rows.filter((row) => hasPlace(row) && row[column] !== null);
    const places = labelPlaces(labelled.map((row) => ({
        x: shareOn(x, row) * across,
        y: (1 - shareOn(y, row)) * up,
        label: textOf(row[column]),
    })), across);
    for (const [i, row] of labelled.entries()) {
        row["label text"] = textOf(row[column]); // Vega breaks texts into lines, and no numbers
        [row["label align"], row["label dx"], row["label dy"]] = places[i] ?? [];
    }
    const placed = (field) => ({ expr: `datum['label ${field}']` });
    return {
        transform: [{ filter: "isValid(datum['label align'])" }],
        mark: { type: "text", fontSize: 11, color: INK, align: placed("align"), dx: placed("dx"), dy: placed("dy") },
        encoding: { text: { field: "label text", type: "nominal" } },
    };
}
