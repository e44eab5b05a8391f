// SPDX-License-Identifier: Zlib
//
// Texts next to the picture: what its colours mean, and how many pairs are wrong in each frame and in all.

function element(tag, className, ...children) {
    const made = document.createElement(tag);
    made.className = className;
    made.append(...children);
    return made;
}

const thousands = (number) => number.toLocaleString("en");
const metres = (number) => `${Number(number.toPrecision(3))} m`;

// A colour and its meaning.
const swatch = (colour, text) => {
    const box = element("span", "swatch");
    box.style.background = colour;
    return element("span", "", box, ` ${text}`);
};

const isWrong = ({ missingInAll, extraInAll }) => missingInAll + extraInAll > 0;
const NONE_WRONG = "No broadphase has a wrong pair in the recorded frames.";

// "3 missing, 1,200 extra"; "0".
function faultsOf(missing, extra) {
    const counts = Object.entries({ missing, extra }).filter(([, count]) => count > 0);
    return counts.map(([kind, count]) => `${thousands(count)} ${kind}`).join(", ") || "0";
}

// Of all broadphases, as texts and elements.
function faultsOfAll({ broadphases }) {
    if (!broadphases.some(isWrong)) {
        return [NONE_WRONG];
    }
    const each = broadphases.map(({ name, missingInAll, extraInAll }, i) => {
        const end = i + 1 < broadphases.length ? "; " : ".";
        return [element("span", "", `${name} ${faultsOf(missingInAll, extraInAll)}`), end];
    });
    return ["Wrong pairs, sum of all recorded frames: ", ...each.flat()];
}

// The method's mark, as in charts; none of a method that has no look of its own.
const SHAPE_LETTERS = {
    circle: "\u25cf", square: "\u25a0", diamond: "\u25c6", cross: "\u271a",
    "triangle-up": "\u25b2", "triangle-down": "\u25bc",
};

function showMethod(box, name) {
    const { colour, shape } = fixedLook(name) ?? {};
    box.style.color = colour === undefined ? "" : `var(--series-${colour})`;
    box.textContent = SHAPE_LETTERS[shape] ?? "";
}

function legendOf({ colouring, heights, cellSize, ground, screen }, { low, broadphases }) {
    const legend = [
        swatch(MISSING_COLOUR, "missing: overlap, not listed"),
        swatch(EXTRA_COLOUR, "extra: listed, do not overlap"),
    ];
    if (ground) {
        legend.push(swatch(SCREENS[screen].ground, "terrain"));
    }
    if (colouring === "overlaps") {
        const counts = ["0 overlaps", "2", "4", "6", "8 or more"];
        return [...legend, ...counts.map((count, i) => swatch(OVERLAP_COLOURS[i], count))];
    }
    if (colouring === "height") {
        const bar = element("span", "ramp");
        bar.style.background = `linear-gradient(to right, ${HEIGHT_COLOURS.join(", ")})`;
        const [from, to] = heights.map((height) => metres(low[1] + height));
        return [...legend, element("span", "", `centre at y = ${from} `, bar, ` ${to}`)];
    }
    const owner = broadphases.find((each) => each.cellSize === cellSize)?.name;
    const whose = owner ? `the finest cells of ${owner}` : "no broadphase uses this size";
    const words =
        `other colours: the cell of an object's lowest corner. Cells are ${metres(cellSize)} wide ` +
        `(${whose}); neighbouring cells differ in colour`;
    return [...legend, element("span", "", words)];
}

// How many pairs are wrong in each frame, as bars over the slider.
function drawWrongPairs(canvas, { missing, extra }, frame, frames) {
    canvas.width = Math.round(canvas.clientWidth * devicePixelRatio) || 1;
    canvas.height = Math.round(canvas.clientHeight * devicePixelRatio) || 1;
    const context = canvas.getContext("2d");
    const most = Math.max(1, ...missing.map((count, i) => count + extra[i]));
    const step = canvas.width / frames;
    const bar = (at, from, count, colour) => {
        // Every number above 0 is visible.
        const height = count > 0 ? Math.max(2, (count / most) * canvas.height) : 0;
        context.fillStyle = colour;
        context.fillRect(at * step, canvas.height - from - height, Math.max(1, step - 1), height);
        return from + height;
    };
    context.fillStyle = "#8888884d";
    context.fillRect(frame * step, 0, Math.max(2, step - 1), canvas.height);
    for (let at = 0; at < frames; ++at) {
        bar(at, bar(at, 0, missing[at], MISSING_COLOUR), extra[at], EXTRA_COLOUR);
    }
}
