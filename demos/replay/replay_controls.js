// SPDX-License-Identifier: Zlib
//
// What is around the picture: buttons, choices, a legend, and what they look like.

function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) {
            made.addEventListener(name.slice(2), value);
        } else {
            made.setAttribute(name, value);
        }
    }
    made.append(...children);
    return made;
}

const button = (text, label, onclick) =>
    element("button", { type: "button", "aria-label": label, title: label, onclick }, text);

// Of options, a value and a text each; `chosen` is told the value.
function choice(label, name, options, now, chosen) {
    const each = options.map(([value, text]) => element("option", { value }, text));
    const select = element("select", { name, onchange: () => chosen(select.value) }, ...each);
    select.value = now;
    return { select, label: element("label", {}, `${label} `, select) };
}

const thousands = (number) => number.toLocaleString("en");
const metres = (number) => `${Number(number.toPrecision(3))} m`;

// A colour and what it stands for.
const swatch = (colour, text) => {
    const box = element("span", { class: "swatch" });
    box.style.background = colour;
    return element("span", {}, box, ` ${text}`);
};

function legendOf({ colouring, heights, cellSize }, { low, broadphases }) {
    const legend = [
        swatch(MISSING_COLOUR, "missing: overlap, not listed"),
        swatch(EXTRA_COLOUR, "extra: listed, do not overlap"),
    ];
    if (colouring === "overlaps") {
        const counts = ["overlaps none", "2", "4", "6", "8 or more others"];
        return [...legend, ...counts.map((count, i) => swatch(OVERLAP_COLOURS[i], count))];
    }
    if (colouring === "height") {
        const bar = element("span", { class: "ramp" });
        bar.style.background = `linear-gradient(to right, ${HEIGHT_COLOURS.join(", ")})`;
        const [from, to] = heights.map((height) => metres(low[1] + height));
        return [...legend, element("span", {}, `y = ${from} `, bar, ` ${to}`)];
    }
    const owner = broadphases.find((each) => each.cellSize === cellSize)?.name;
    const whose = owner ? `the finest of ${owner}` : "which is no broadphase's own size";
    const words =
        `cells of ${metres(cellSize)}, ${whose}, in eight colours: cells side by side differ; ` +
        "a body is in that of its lowest corner";
    return [...legend, element("span", {}, words)];
}

// How many pairs are wrong in each frame, as bars over the slider.
class WrongChart {
    constructor() {
        this.canvas = element("canvas", { class: "wrong-chart", "aria-hidden": "true" });
    }

    draw({ missing, extra }, frame, frames) {
        const { canvas } = this;
        canvas.width = Math.round(canvas.clientWidth * devicePixelRatio) || 1;
        canvas.height = Math.round(canvas.clientHeight * devicePixelRatio) || 1;
        const context = canvas.getContext("2d");
        const most = Math.max(1, ...missing.map((count, i) => count + extra[i]));
        const step = canvas.width / frames;
        const bar = (at, from, count, colour) => {
            // What is not zero is to be seen.
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
}

// Dragging orbits, with Shift or the right button it pans, two fingers zoom; so do the wheel and keys.
function steerByPointer(canvas, camera, changed) {
    const pointers = new Map();
    const fingersApart = () => {
        const [a, b] = [...pointers.values()];
        return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    canvas.addEventListener("pointermove", (event) => {
        const last = pointers.get(event.pointerId);
        if (!last) {
            return;
        }
        const apart = pointers.size === 2 ? fingersApart() : 0;
        const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
        Object.assign(last, { x: event.clientX, y: event.clientY });
        if (apart > 0) {
            camera.zoom(apart / Math.max(1, fingersApart()));
        } else if (event.shiftKey || event.buttons & 2) {
            camera.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
        } else {
            camera.orbit(-dx * 0.008, dy * 0.008);
        }
        changed();
    });
    for (const end of ["pointerup", "pointercancel"]) {
        canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    const wheel = (event) => {
        event.preventDefault();
        camera.zoom(Math.exp(event.deltaY * 0.0015));
        changed();
    };
    canvas.addEventListener("wheel", wheel, { passive: false });
}

function steerByKeys(canvas, camera, changed) {
    const keys = {
        ArrowLeft: () => camera.orbit(-0.1, 0),
        ArrowRight: () => camera.orbit(0.1, 0),
        ArrowUp: () => camera.orbit(0, 0.1),
        ArrowDown: () => camera.orbit(0, -0.1),
        "+": () => camera.zoom(0.8),
        "-": () => camera.zoom(1.25),
    };
    canvas.addEventListener("keydown", (event) => {
        if (keys[event.key]) {
            event.preventDefault();
            keys[event.key]();
            changed();
        }
    });
}

function cameraButtons(camera, changed) {
    const steer = (text, label, act) =>
        button(text, label, () => {
            act();
            changed();
        });
    return element(
        "div",
        { class: "camera", role: "group", "aria-label": "Camera" },
        steer("\u21ba", "Turn left", () => camera.orbit(-0.3, 0)),
        steer("\u21bb", "Turn right", () => camera.orbit(0.3, 0)),
        steer("+", "Closer", () => camera.zoom(0.7)),
        steer("\u2212", "Farther", () => camera.zoom(1 / 0.7)),
        steer("Top", "From above", () => camera.lookDown()),
        steer("Reset", "As at first", () => camera.reset()),
    );
}
