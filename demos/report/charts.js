// SPDX-License-Identifier: Zlib
//
// Charts as Vega-Lite draws them (https://vega.github.io/vega-lite/), of charts as they are declared
// (demos/experiment/findings.hpp): chartSpec(). Colours are variables of page.css.

const SHAPES = ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down"];
const DASHES = [[1, 0], [8, 4], [2, 3], [10, 3, 2, 3], [4, 4], [14, 4]];
const COLOURS = 7; // --series-0 and so on
const INK = "var(--ink)";
const WIDTH = 660; // [px], of a chart with the names at its left
const HEIGHT = 360;
const LETTER = 7; // [px], the width of one

const CONFIG = (() => {
    const texts = {
        labelColor: INK, titleColor: INK, labelFontSize: 12, titleFontSize: 13, titleFontWeight: "normal",
        labelLimit: 0,
    };
    return {
        font: "system-ui, sans-serif",
        background: null,
        padding: 2,
        view: { stroke: null },
        axis: {
            ...texts, gridColor: "var(--faint)", domainColor: INK, tickColor: INK, titlePadding: 8, maxExtent: 400,
            tickCount: 8, labelOverlap: true,
        },
        legend: {
            ...texts, orient: "bottom", direction: "horizontal", symbolSize: 90, columnPadding: 18, titleLimit: 0,
            gradientLength: 300, offset: 14, layout: { bottom: { anchor: "start", direction: "vertical" } },
        },
        title: {
            anchor: "start", frame: "bounds", color: INK, subtitleColor: INK, fontSize: 15, subtitleFontSize: 12,
            subtitlePadding: 6, offset: 16,
        },
    };
})();

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

const seriesOf = (chart) => (chart.series ? distinct(valuesOf(chart, chart.series).map(textOf)) : []);

// --- How series look ------------------------------------------------------------------------------

// A series is named "method", or "method, variant".
const methodOf = (series) => series.split(", ")[0];

// The number that is used least; each use has a rank, of which the lowest counts most.
function leastUsed(count, uses) {
    const weight = (number) =>
        uses.reduce((sum, [used, rank]) => sum + (used === number ? 1000 ** -rank : 0), 0);
    const weights = Array.from({ length: count }, (_, number) => weight(number));
    return weights.indexOf(Math.min(...weights));
}

// Colour, shape and dash of each series, the same in all charts. What is of one method has one colour. Methods
// that share a chart differ in colour as long as there are colours, and series of one colour in a chart in
// shape as long as there are shapes.
function looksOf(charts) {
    const all = charts.map(seriesOf);
    const matesOf = (name, nameOf) =>
        new Set(all.map((each) => each.map(nameOf)).filter((each) => each.includes(name)).flat());
    const looks = new Map();
    const colours = new Map(); // by method
    for (const name of distinct(all.flat())) {
        const method = methodOf(name);
        if (!colours.has(method)) {
            const mates = matesOf(method, methodOf);
            const uses = [...colours].map(([other, colour]) => [colour, mates.has(other) ? 0 : 1]);
            colours.set(method, leastUsed(COLOURS, uses));
        }
        const colour = colours.get(method);
        const mates = matesOf(name, (each) => each);
        const uses = [...looks].map(([other, look]) =>
            [look.shape, !mates.has(other) ? 2 : look.colour === colour ? 0 : 1]);
        const variant = [...looks.keys()].filter((other) => methodOf(other) === method).length;
        looks.set(name, { colour, shape: leastUsed(SHAPES.length, uses), dash: variant % DASHES.length });
    }
    return looks;
}

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

// "missed log0": the column, its channel, where its numbers stand as shares of the axis, if anywhere, and which
// names it has. A logarithmic axis has 0, where log0 allows it, apart on a dotted line below the smallest
// number; its numbers and those of the other columns become places by `transform`.
function axisOf(chart, words, others = []) {
    const [column, kind = "linear"] = words.split(" ");
    const { title } = chart.data.columns.find((each) => each.name === column);
    const channel = { field: fieldOf(column), title: title || column };
    if (kind === "names") {
        const names = distinct(valuesOf(chart, column).map(textOf));
        const type = chart.mark === "bar" || chart.mark === "cell" ? "band" : "point";
        return {
            column, names, channel: { ...channel, type: "nominal", sort: names, scale: { type }, axis: { grid: false } },
        };
    }
    channel.type = "quantitative";
    const numbers = [column, ...others].flatMap((each) => valuesOf(chart, each)).filter(Number.isFinite);
    const positive = numbers.filter((number) => number > 0);
    if (kind === "linear" || positive.length === 0) {
        const domain = [Math.min(0, ...numbers), Math.max(...numbers)];
        return { column, channel, shareOf: vega.scale("linear")().domain(domain) };
    }
    let low = Math.min(...positive);
    const high = Math.max(...positive);
    const ratio = Math.max(high / low, 2);
    const isBar = chart.mark === "bar";
    if (isBar) {
        low = 10 ** Math.floor(Math.log10(low / 1.5)); // of a bar something is seen
    }
    const zero = kind === "log0" && numbers.includes(0) ? low * ratio ** -0.12 : null;
    const axis = { values: logTicks(low, high), labelExpr: TICK_LABEL };
    if (zero !== null) {
        const isZero = `datum.value < ${low}`;
        axis.values.unshift(zero);
        axis.labelExpr = `${isZero} ? '0' : ${TICK_LABEL}`;
        axis.gridDash = { condition: { test: isZero, value: [1, 3] }, value: [] };
        axis.gridColor = { condition: { test: isZero, value: INK }, value: "var(--faint)" };
    }
    const domain = [zero === null ? low : isBar ? zero * ratio ** -0.03 : zero, high];
    const scale = { type: "log", domain, nice: false, padding: isBar ? 0 : 12 };
    // What a logarithm does not reach has no place.
    const place = (field) =>
        `datum['${field}'] > 0 ? datum['${field}'] : datum['${field}'] === 0 ? ${zero} : null`;
    return {
        column,
        begin: domain[0],
        transform: [column, ...others].map((each) => ({ calculate: place(fieldOf(each)), as: placeOf(each) })),
        channel: { ...channel, field: placeOf(column), scale, axis },
        shareOf: (number) => vega.scale("log")().domain(domain)(number > 0 ? number : number === 0 ? zero : null),
    };
}

// Fields of Vega-Lite, which reads some letters as paths.
const fieldOf = (column) => column.replace(/\W/g, "_");
const placeOf = (column) => `at ${fieldOf(column)}`;

// --- Labels of points -----------------------------------------------------------------------------

const PLACES = [
    ["left", 7, -7], ["right", -7, -7], ["left", 7, 8], ["right", -7, 8],
    ["center", 0, -12], ["center", 0, 13], ["left", 9, 0], ["right", -9, 0],
];

// Of eight places around a point the first in which its label hides neither points nor other labels and ends
// beyond no side, else the one where it hides least: [align, dx, dy].
function labelPlaces(points) {
    const far = 1e6;
    const taken = [[-far, -far, 0, far], [WIDTH, -far, far, far]]; // left, top, right, bottom
    taken.push(...points.map(({ x, y }) => [x - 4, y - 4, x + 4, y + 4]));
    return points.map(({ x, y, label }) => {
        const boxes = PLACES.map(([align, dx, dy]) => {
            const width = (LETTER - 1) * label.length;
            const left = x + dx - width * { left: 0, right: 1, center: 0.5 }[align];
            return [left, y + dy - 6, left + width, y + dy + 6];
        });
        const shared = (a, b) =>
            Math.max(0, Math.min(a[2], b[2]) - Math.max(a[0], b[0]))
            * Math.max(0, Math.min(a[3], b[3]) - Math.max(a[1], b[1]));
        const hidden = boxes.map((box) => taken.reduce((sum, each) => sum + shared(box, each), 0));
        const best = hidden.indexOf(Math.min(...hidden));
        taken.push(boxes[best]);
        return PLACES[best];
    });
}

function labelLayer(chart, x, y, rows) {
    const column = fieldOf(chart.label);
    const shareOn = (axis, row) => axis.shareOf(row[fieldOf(axis.column)]);
    const hasPlace = (row) => [x, y].every((axis) => Number.isFinite(shareOn(axis, row)));
    const labelled = rows.filter((row) => hasPlace(row) && row[column] !== null);
    const places = labelPlaces(labelled.map((row) => ({
        x: shareOn(x, row) * WIDTH,
        y: (1 - shareOn(y, row)) * HEIGHT,
        label: textOf(row[column]),
    })));
    labelled.forEach((row, i) => ([row["label align"], row["label dx"], row["label dy"]] = places[i]));
    const placed = (field) => ({ expr: `datum['label ${field}']` });
    return {
        transform: [{ filter: "isValid(datum['label align'])" }],
        mark: { type: "text", fontSize: 11, color: INK, align: placed("align"), dx: placed("dx"), dy: placed("dy") },
        encoding: { text: { field: column, type: "nominal" } },
    };
}

// --- Layers ---------------------------------------------------------------------------------------

// A dashed line of no series, with its name in the legend.
const namedLine = (name, dash, rest) => ({
    ...rest,
    mark: { type: "line", color: INK, strokeWidth: 1.5 },
    encoding: {
        ...rest.encoding,
        strokeDash: {
            datum: name,
            scale: { range: [dash] },
            legend: { title: null, symbolType: "stroke", symbolSize: 700, symbolStrokeColor: INK },
        },
    },
});

// Through the points that no other beats in both x and y; of equals the first.
function frontLayer(rows, x, y) {
    const points = rows.filter((row) => [row[x], row[y]].every(Number.isFinite));
    let least = Infinity;
    for (const row of points.sort((a, b) => a[x] - b[x] || a[y] - b[y])) {
        row["in front"] = row[y] < least;
        least = Math.min(least, row[y]);
    }
    return namedLine("no point is better in both", [2, 3], { transform: [{ filter: "datum['in front']" }] });
}

// One line for all series where they share a theory, else one for each in its colour.
function theoryLayer(chart, columnX, field, along, colour) {
    const at = new Map();
    const theories = valuesOf(chart, chart.theory);
    const isShared = valuesOf(chart, columnX).every((x, i) => {
        at.set(x, at.get(x) ?? theories[i]);
        return at.get(x) === theories[i];
    });
    const { title } = chart.data.columns.find((each) => each.name === chart.theory);
    return namedLine(title || chart.theory, [6, 4], {
        encoding: { [along]: { field, type: "quantitative" }, ...(isShared || !chart.series ? {} : { color: colour }) },
    });
}

const cellLayers = (shade, tooltip) => {
    const value = `datum['${shade.channel.field}']`;
    const { axis, scale, ...channel } = shade.channel;
    return [
        {
            mark: "rect",
            encoding: {
                color: {
                    ...channel,
                    scale: { ...scale, padding: 0, scheme: "viridis" },
                    legend: axis ? { values: axis.values, labelExpr: axis.labelExpr } : {},
                },
                tooltip,
            },
        },
        {
            transform: [{ filter: `isValid(${value})` }],
            mark: {
                type: "text",
                fontSize: 11,
                text: { expr: `format(${value}, ${value} >= 1000 ? ',.0f' : '.4~g')` },
                color: { expr: `luminance(scale('color', ${value})) > 0.25 ? '#000000' : '#ffffff'` },
            },
        },
    ];
};

// --- The chart ------------------------------------------------------------------------------------

const longest = (names) => Math.max(0, ...names.map((name) => name.length));

// Width and height, and whether bars lie, as they do where their names would not stand side by side; sets how
// names are written.
function layOut(chart, x, y, isOneSeries) {
    const doesLie = chart.mark === "bar" && (longest(x.names) + 2) * x.names.length * LETTER > WIDTH;
    if (x.names) {
        x.channel.axis.labelAngle = 0;
    }
    if (doesLie) {
        x.channel.title = null; // the names speak for themselves
    } else if (y.names?.every((name) => /^[\d.,e+-]+$/.test(name))) {
        y.channel.sort = [...y.names].reverse();
    }
    const left = doesLie ? x : y;
    if (!left.names) {
        return { doesLie, width: WIDTH, height: HEIGHT };
    }
    left.channel.axis.labelLimit = 320; // about 45 letters
    return {
        doesLie,
        width: WIDTH - Math.min(longest(left.names), 45) * LETTER,
        height: { step: doesLie && !isOneSeries ? 18 : 27 },
    };
}

// How series are told apart: by colour, shape of points, and dash of lines.
function seriesChannels(chart, series, looks, hasLegend) {
    const columns = Math.max(1, Math.floor(WIDTH / (longest(series) * LETTER + 30)));
    const bySeries = (of, legend) =>
        series.length === 0 ? { value: of({ colour: 0, shape: 0, dash: 0 }) } : {
            field: fieldOf(chart.series),
            type: "nominal",
            title: null,
            scale: { domain: series, range: series.map((name) => of(looks.get(name))) },
            legend: hasLegend ? legend : null,
        };
    return {
        color: bySeries(({ colour }) => `var(--series-${colour})`, { columns }),
        shape: bySeries(({ shape }) => SHAPES[shape], { columns }),
        strokeDash: bySeries(({ dash }) => DASHES[dash], null),
    };
}

// The specification of a chart; looksOf() the charts of its page are `looks`.
function chartSpec(chart, looks) {
    const { mark = "line", low, high, theory, data } = chart;
    const x = axisOf(chart, chart.x);
    const y = axisOf(chart, chart.y, [low, high, theory].filter(Boolean));
    const shade = chart.shade && axisOf(chart, chart.shade);
    const series = seriesOf(chart);
    const isOneSeries = series.length === 0 || chart.series === x.column;
    const { doesLie, width, height } = layOut(chart, x, y, isOneSeries);
    const { color, shape, strokeDash } = seriesChannels(chart, series, looks, !isOneSeries);
    const [across, along] = doesLie ? ["y", "x"] : ["x", "y"];
    const onY = (column) => (y.begin ? placeOf(column) : fieldOf(column));

    const named = [x, y].filter((axis) => axis.names).map((axis) => axis.column);
    const rows = data.rows.map((row) =>
        Object.fromEntries(data.columns.map(({ name }, i) =>
            [fieldOf(name), named.includes(name) ? textOf(row[i]) : row[i]])));
    const tooltip = data.columns.map(({ name, title }) => ({
        field: fieldOf(name),
        title: title || name,
        ...(rows.some((row) => typeof row[fieldOf(name)] === "string")
            ? { type: "nominal" } : { type: "quantitative", format: ",.4~g" }),
    }));

    const isDense = mark === "line" && rows.length > Math.max(series.length, 1) * 40;
    const points = {
        mark: { type: "point", filled: true, opacity: 1, size: isDense ? 12 : 60 },
        encoding: { color, shape, tooltip },
    };
    const errors = {
        mark: { type: "rule", strokeWidth: 1.5 },
        encoding: {
            [along]: { ...y.channel, field: onY(low ?? "") },
            [`${along}2`]: { field: onY(high ?? "") },
            color: mark === "bar" ? { value: INK } : color,
        },
    };
    const lines = { mark: { type: "line", strokeWidth: 2, order: null }, encoding: { color, strokeDash } }; // as the rows
    const bars = {
        mark: { type: "bar", orient: doesLie ? "horizontal" : "vertical" },
        encoding: { color, tooltip, ...(y.begin ? { [`${along}2`]: { datum: y.begin } } : {}) },
    };
    return {
        $schema: "https://vega.github.io/schema/vega-lite/v6.json",
        description: chart.title,
        width,
        height,
        data: { values: rows },
        transform: [x, y, shade].flatMap((axis) => axis?.transform ?? []),
        encoding: {
            [across]: x.channel,
            [along]: y.channel,
            ...(mark === "bar" && !isOneSeries
                ? { [`${across}Offset`]: { field: fieldOf(chart.series), sort: series } } : {}),
        },
        layer: [
            chart.front ? frontLayer(rows, fieldOf(x.column), fieldOf(y.column)) : [],
            { cell: () => cellLayers(shade, tooltip), bar: () => bars, line: () => lines, point: () => [] }[mark](),
            low ? errors : [],
            theory ? theoryLayer(chart, x.column, onY(theory), along, color) : [],
            mark === "line" || mark === "point" ? points : [],
            chart.label ? labelLayer(chart, x, y, rows) : [],
        ].flat(),
        resolve: { scale: { strokeDash: "independent" } },
        config: CONFIG,
    };
}
