// SPDX-License-Identifier: Zlib
//
// Charts as Vega-Lite draws them (https://vega.github.io/vega-lite/), of charts as they are declared
// (demos/experiment/findings.hpp): chartSpec(). Colours are variables of page.css. Its axes are in chart_axes.js,
// the looks of methods in method_looks.js.

const SHAPES = ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down"];
const DASHES = [[1, 0], [8, 4], [2, 3], [10, 3, 2, 3], [4, 4], [14, 4]];
const COLOURS = 7; // --series-0 and so on
const INK = "var(--ink)";
const WIDTH = 760; // [px], of a drawing in a file
const HEIGHT = 360; // [px], of axes with numbers
const LABELS = 64; // [px], about the width of an axis' numbers and title
const LINE = 14; // [px], the height of one of text
const TITLE_LETTER = 10; // [px], the width of a letter of an axis' title, as Vega takes it where it draws no page

const FRONT = "no point is better in both"; // of a line through points, in the legend

const CONFIG = (() => {
    const texts = {
        labelColor: INK, titleColor: INK, labelFontSize: 12, titleFontSize: 13, titleFontWeight: "normal",
        labelLimit: 0,
    };
    return {
        font: "system-ui, sans-serif",
        background: null,
        padding: 2,
        lineBreak: "\n", // in names
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

// Colour, shape and dash of each series, the same in all charts. What METHOD_LOOKS has looks so. Of the others,
// what is of one method has one colour; methods that share a chart differ in colour as long as there are
// colours, and series of one colour in a chart in shape as long as there are shapes.
function looksOf(charts) {
    const all = charts.map(seriesOf);
    const matesOf = (name, nameOf) =>
        new Set(all.map((each) => each.map(nameOf)).filter((each) => each.includes(name)).flat());
    const looks = new Map();
    const colours = new Map(); // by method, of those without one of their own
    const newColour = (method) => {
        const mates = matesOf(method, methodOf);
        const uses = [...looks].map(([other, look]) => [look.colour, mates.has(methodOf(other)) ? 0 : 1]);
        colours.set(method, leastUsed(COLOURS, uses));
        return colours.get(method);
    };
    const fixedFirst = (name) => (fixedLook(name)?.shape ? 0 : fixedLook(name) ? 1 : 2);
    for (const name of distinct(all.flat()).sort((a, b) => fixedFirst(a) - fixedFirst(b))) {
        const fixed = fixedLook(name);
        const method = methodOf(name);
        const colour = fixed?.colour ?? colours.get(method) ?? newColour(method);
        const mates = matesOf(name, (each) => each);
        const uses = [...looks].map(([other, look]) =>
            [look.shape, !mates.has(other) ? 2 : look.colour === colour ? 0 : 1]);
        const dashes = [...looks]
            .filter(([other, look]) => look.colour === colour && (mates.has(other) || methodOf(other) === method))
            .map(([, look]) => [look.dash, 0]);
        looks.set(name, {
            colour,
            shape: fixed?.shape ? SHAPES.indexOf(fixed.shape) : leastUsed(SHAPES.length, uses),
            dash: leastUsed(DASHES.length, dashes),
        });
    }
    return looks;
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
function frontLayer(rows, x, y, name) {
    const points = rows.filter((row) => [row[x], row[y]].every(Number.isFinite));
    let least = Infinity;
    for (const row of points.sort((a, b) => a[x] - b[x] || a[y] - b[y])) {
        row["in front"] = row[y] < least;
        least = Math.min(least, row[y]);
    }
    return namedLine(name, [2, 3], { transform: [{ filter: "datum['in front']" }] });
}

// One line for all series where they share a theory, else one for each in its colour.
function theoryLayer(chart, columnX, field, along, colour, write) {
    const at = new Map();
    const theories = valuesOf(chart, chart.theory);
    const isShared = valuesOf(chart, columnX).every((x, i) => {
        at.set(x, at.get(x) ?? theories[i]);
        return at.get(x) === theories[i];
    });
    return namedLine(write(titleOf(chart, chart.theory)), [6, 4], {
        encoding: { [along]: { field, type: "quantitative" }, ...(isShared || !chart.series ? {} : { color: colour }) },
    });
}

// `digits` are significant ones of the numbers in the cells.
const cellLayers = (shade, digits, tooltip, gradientLength) => {
    const value = `datum['${shade.channel.field}']`;
    const { axis, scale, ...channel } = shade.channel;
    return [
        {
            mark: "rect",
            encoding: {
                color: {
                    ...channel,
                    scale: { ...scale, padding: 0, scheme: "viridis" },
                    legend: { gradientLength, ...(axis && { values: axis.values, labelExpr: axis.labelExpr }) },
                },
                tooltip,
            },
        },
        {
            transform: [{ filter: `isValid(${value})` }],
            mark: {
                type: "text",
                fontSize: 11,
                text: { expr: `format(${value}, ${value} >= 1000 ? ',.${digits}r' : '.${digits}~g')` },
                color: { expr: `luminance(scale('color', ${value})) > 0.25 ? '#000000' : '#ffffff'` },
            },
        },
    ];
};

// --- The chart ------------------------------------------------------------------------------------

// How the names of an axis are written: in lines of at most so many letters.
function writeNames(axis, letters) {
    const lines = axis.names.map((name) => linesOf(name, letters));
    axis.written = (name) => linesOf(name, letters).join("\n");
    axis.width = longest(lines.flat()) * LETTER;
    axis.lines = Math.max(...lines.map((each) => each.length));
    axis.channel.sort = axis.names.map(axis.written);
    Object.assign(axis.channel.axis, { labelAngle: 0, labelOverlap: false });
}

// Whether bars and points with names lie, as they do where they are of one series, or their names would not be
// side by side, and the lengths of the axes [px]; sets how names and titles are written. Only cells, each of which
// holds its number, may make a chart wider than `width`.
function layOut(chart, x, y, seriesInARow, width) {
    const hasRows = chart.mark === "bar" || chart.mark === "point";
    const doesLie = Boolean(hasRows && x.names
        && (seriesInARow === 1 || (longest(x.names) + 2) * x.names.length * LETTER > width - LABELS));
    const [below, left] = doesLie ? [y, x] : [x, y];
    let leftWidth = LABELS;
    let up = HEIGHT;
    if (left.names) {
        writeNames(left, Math.min(45, Math.floor(0.35 * width / LETTER)));
        // All lines of a name are about the middle of its row.
        const dy = { signal: `${-LINE / 2} * (length(split(datum.label, '\\n')) - 1)` };
        left.channel.axis.encoding = { labels: { dy: { value: dy } } };
        leftWidth = left.width + (doesLie ? 20 : 40);
        const ofSeries = chart.mark === "bar" ? 18 : 12;
        up = left.names.length * Math.max(seriesInARow * ofSeries, left.lines * LINE + 13);
    }
    let across = width - leftWidth;
    if (chart.mark === "cell") {
        const texts = valuesOf(chart, chart.shade.split(" ")[0]).map(textOf);
        texts.push(...x.names.flatMap((name) => name.split(" ")));
        across = Math.max(across, (longest(texts) * LETTER + 6) * x.names.length);
    }
    if (below.names) {
        writeNames(below, Math.floor(across / below.names.length / LETTER));
    }
    below.channel.title = linesOf(below.channel.title, Math.floor(across / TITLE_LETTER));
    if (doesLie) {
        left.channel.title = null; // the names speak for themselves
    } else {
        left.channel.title = linesOf(left.channel.title, Math.floor(up / TITLE_LETTER));
        if (left.names?.every((name) => /^[\d.,e+-]+$/.test(name))) {
            left.channel.sort.reverse();
        }
    }
    return { doesLie, across, up, width: across + leftWidth };
}

// How series are told apart: by colour, shape of points, and dash of lines. `write` writes their names; the
// legend is as wide as the x axis.
function seriesChannels(chart, series, write, looks, legendWidth) {
    const letters = longest(series.flatMap((name) => write(name).split("\n")));
    const columns = Math.max(1, Math.floor(legendWidth / (letters * LETTER + 48)));
    const bySeries = (of, legend) =>
        series.length === 0 ? { value: of({ colour: 0, shape: 0, dash: 0 }) } : {
            field: fieldOf(chart.series),
            type: "nominal",
            title: null,
            scale: { domain: series.map(write), range: series.map((name) => of(looks.get(name))) },
            legend: legendWidth > 0 ? legend : null,
        };
    return {
        color: bySeries(({ colour }) => `var(--series-${colour})`, { columns }),
        shape: bySeries(({ shape }) => SHAPES[shape], { columns }),
        strokeDash: bySeries(({ dash }) => DASHES[dash], null),
    };
}

// The specification of a chart that is as wide as that [px]; looksOf() the charts of its page are `looks`.
function chartSpec(chart, looks, width = WIDTH) {
    const { mark = "line", low, high, theory, data } = chart;
    const x = axisOf(chart, chart.x);
    const y = axisOf(chart, chart.y, [low, high, theory].filter(Boolean));
    const shade = chart.shade && axisOf(chart, chart.shade);
    const series = seriesOf(chart);
    const isOneSeries = series.length === 0 || chart.series === x.column;
    const lengths = layOut(chart, x, y, isOneSeries ? 1 : series.length, width);
    const named = new Map([x, y].filter((axis) => axis.names).map((axis) => [axis.column, axis.written]));
    const inLegend = (name) => linesOf(name, Math.floor((lengths.across - 48) / LETTER)).join("\n");
    const writeSeries = named.get(chart.series) ?? inLegend;
    if (chart.series) {
        named.set(chart.series, writeSeries);
    }
    const { color, shape, strokeDash } =
        seriesChannels(chart, series, writeSeries, looks, isOneSeries ? 0 : lengths.across);
    const [across, along] = lengths.doesLie ? ["y", "x"] : ["x", "y"];
    const sideBySide = { field: fieldOf(chart.series ?? ""), sort: series.map(writeSeries) };
    const onY = (column) => (y.begin ? placeOf(column) : fieldOf(column));

    const rows = data.rows.map((row) =>
        Object.fromEntries(data.columns.map(({ name }, i) =>
            [fieldOf(name), named.has(name) ? named.get(name)(textOf(row[i])) : row[i]])));
    const tooltip = data.columns.map(({ name, title, digits }) => ({
        field: fieldOf(name),
        title: title || name,
        ...(rows.some((row) => typeof row[fieldOf(name)] === "string")
            ? { type: "nominal" } : { type: "quantitative", format: `,.${digits}~g` }),
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
        mark: { type: "bar", orient: lengths.doesLie ? "horizontal" : "vertical" },
        encoding: { color, tooltip },
    };
    return {
        $schema: "https://vega.github.io/schema/vega-lite/v6.json",
        description: chart.title,
        width: lengths.width,
        height: lengths.up,
        autosize: { type: "fit-x", contains: "padding" },
        data: { values: rows },
        transform: [x, y, shade].flatMap((axis) => axis?.transform ?? []),
        encoding: {
            [across]: x.channel,
            [along]: y.channel,
            ...(x.names && mark !== "cell" && !isOneSeries ? { [`${across}Offset`]: sideBySide } : {}),
        },
        layer: [
            chart.front ? frontLayer(rows, fieldOf(x.column), fieldOf(y.column), inLegend(FRONT)) : [],
            {
                cell: () => cellLayers(shade, digitsOf(chart, shade.column), tooltip, Math.min(300, lengths.across)),
                bar: () => bars,
                line: () => lines,
                point: () => [],
            }[mark](),
            low ? errors : [],
            theory ? theoryLayer(chart, x.column, onY(theory), along, color, inLegend) : [],
            mark === "line" || mark === "point" ? points : [],
            chart.label ? labelLayer(chart, x, y, rows, lengths) : [],
        ].flat(),
        resolve: { scale: { strokeDash: "independent" } },
        config: CONFIG,
    };
}
