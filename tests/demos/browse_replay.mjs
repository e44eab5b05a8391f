// SPDX-License-Identifier: Zlib
//
// node browse_replay.mjs <chromium> <page>...
//
// Plays the recordings of pages in headless Chromium, whose WebGL2 is drawn by the processor, and tells
// as JSON, page by page, what was to be seen in each frame. Of the first page also how the picture changes
// with what is chosen, where the first wrong pair is, how fast it draws, what comes of a loss of WebGL2 or
// of another size or density of the screen, and what is said where there is no WebGL2; of the others
// what is said of the pairs, and the colours of bodies in a row.

import { Browser, scheme } from "./browser.mjs";

// What the page's own checks need: its replay, and pictures of it as numbers.
const helpers = `
    window.root = document.querySelector("div.replay");
    window.canvas = root.querySelector("canvas.replay");
    window.pixels = () => {
        const gl = canvas.getContext("webgl2");
        const bytes = new Uint8Array(canvas.width * canvas.height * 4);
        gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        return new Uint32Array(bytes.buffer);
    };
    window.drawnSince = async (draws) => {
        while (root.dataset.draws === draws) {
            await new Promise(requestAnimationFrame);
        }
        return { ...root.dataset };
    };
    window.drawn = (act) => {
        const { draws } = root.dataset;
        act();
        return drawnSince(draws);
    };
    // How many pictures there were, once no more are on their way.
    window.settled = async () => {
        await new Promise(requestAnimationFrame);
        await new Promise(requestAnimationFrame);
        return root.dataset.draws;
    };
    window.scrub = (frame) => drawn(() => {
        const slider = root.querySelector("input[name=frame]");
        slider.value = frame;
        slider.dispatchEvent(new Event("input"));
    });
    window.choose = (name, value) => drawn(() => {
        const control = root.querySelector("[name=" + name + "]");
        if (typeof value === "boolean") {
            control.checked = value;
        } else {
            control.value = value;
        }
        control.dispatchEvent(new Event("change"));
        control.dispatchEvent(new Event("input"));
    });
    window.remembered = {};
    window.remember = (name) => (remembered[name] = pixels());
    window.changedSince = (name) => pixels().filter((pixel, i) => pixel !== remembered[name][i]).length;
`;

const ready = `(async () => {
    const root = document.querySelector("div.replay");
    while (!root.dataset.state || (root.dataset.state === "ready" && !root.dataset.draws)) {
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
    return root.dataset.state;
})()`;

const allFrames = `(async () => {
    const seen = [];
    for (let frame = Number(root.dataset.frames) - 1; frame >= 0; --frame) {
        const { frame: at, pairs, missing, extra } = await scrub(frame);
        seen.unshift([at, pairs, missing, extra].map(Number));
    }
    return seen;
})()`;

// In how many pixels the picture differs from that which was there before.
const changes = `(async () => {
    const changed = {};
    await scrub(0);
    remember("first");
    changed.colours = new Set(pixels()).size;
    await choose("colouring", "height");
    changed.byHeight = changedSince("first");
    await choose("colouring", "cell");
    changed.backByCell = changedSince("first");
    await choose("cellSize", String(2 * root.querySelector("[name=cellSize]").value));
    changed.byLargerCell = changedSince("first");
    const { lines } = await choose("pairs", true);
    remember("pairs");
    changed.lines = Number(lines);
    await choose("pairs", false);
    changed.byPairs = changedSince("pairs");
    remember("last");
    await scrub(root.dataset.frames - 1);
    changed.byLastFrame = changedSince("last");
    return changed;
})()`;

const wrongPair = `(() => {
    const marks = JSON.parse(root.dataset.marks);
    const image = pixels();
    const redAround = ([x, y]) => {
        let red = 0;
        for (let dy = -12; dy <= 12; ++dy) {
            for (let dx = -12; dx <= 12; ++dx) {
                const at = (Math.round(y) + dy) * canvas.width + Math.round(x) + dx;
                const [r, g, b] = [image[at] & 255, (image[at] >> 8) & 255, (image[at] >> 16) & 255];
                red += r > 150 && g < 160 && b < 100;
            }
        }
        return red;
    };
    return {
        ...root.dataset,
        frame: Number(root.dataset.frame),
        words: root.querySelector(".words").textContent,
        inPicture: marks.every(([x, y]) => x > 0 && y > 0 && x < canvas.width && y < canvas.height),
        redAtMarks: marks.map(redAround),
    };
})()`;

// With the picture read back each time, so that it has been drawn.
const framesASecond = `(async () => {
    const begin = performance.now();
    const draws = 10;
    for (let i = 0; i < draws; ++i) {
        await scrub(i % root.dataset.frames);
        pixels();
    }
    return (1000 * draws) / (performance.now() - begin);
})()`;

async function press(tab, key) {
    const text = key.length === 1 ? { text: key } : {};
    await tab("Input.dispatchKeyEvent", { type: "keyDown", key, ...text });
    await tab("Input.dispatchKeyEvent", { type: "keyUp", key });
}

// Does something to the browser, and waits for the picture that comes of it.
async function pictureAfter(evaluate, act) {
    const draws = await evaluate("settled()");
    await act();
    const { frame, colouring } = await evaluate(`drawnSince("${draws}")`);
    return { frame: Number(frame), colouring };
}

async function byKeys({ tab, evaluate }) {
    const after = (key) => pictureAfter(evaluate, () => press(tab, key));
    await evaluate("canvas.focus()");
    await evaluate("scrub(0)");
    const seen = { next: await after("."), last: await after("End"), home: await after("Home") };
    seen.coloured = await after("c");
    await evaluate("remember('key')");
    await after("ArrowLeft");
    seen.changedByTurning = await evaluate("changedSince('key')");
    seen.played = await after(" ");
    await press(tab, " ");
    seen.playing = await evaluate("root.dataset.playing");
    return seen;
}

// Keys that are pressed while the focus is not in the tab's contents.
async function byKeysElsewhere({ tab, evaluate }) {
    const after = async (key) => {
        await press(tab, key);
        return evaluate("[Number(root.dataset.frame), root.dataset.playing === 'true']");
    };
    const focus = (what) => evaluate(`scrub(3).then(() => ${what})`);
    await focus("document.getElementById('tab-replay').focus()");
    const seen = { onTab: [await after("."), await after(" ")] };
    await focus("document.activeElement.blur()");
    seen.nowhere = [await after("."), await after("End"), await after(" "), await after(" ")];
    await focus("root.querySelector('[name=cellSize]').focus()");
    seen.typing = await after(".");
    await focus("document.getElementById('tab-report').click()");
    seen.hidden = await after(",");
    await evaluate("document.getElementById('tab-replay').click()");
    return seen;
}

const lossOfContext = `(async () => {
    const lose = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    const happens = (name) => new Promise((resolve) => {
        canvas.addEventListener(name, () => resolve(true), { once: true });
        setTimeout(() => resolve(false), 5000);
    });
    await scrub(2);
    remember("whole");
    root.querySelector("[aria-label=Play]").click();
    const lost = happens("webglcontextlost");
    lose.loseContext();
    await lost;
    root.querySelector(".time button").click(); // nothing can be played now
    const during = { state: root.dataset.state, playing: root.dataset.playing };
    await new Promise((resolve) => setTimeout(resolve));
    const restored = happens("webglcontextrestored");
    lose.restoreContext();
    if (!(await restored)) {
        return { during };
    }
    await scrub(2);
    return { during, state: root.dataset.state, changed: changedSince("whole") };
})()`;

// The picture has as many pixels as the screen.
async function onScreens({ tab, evaluate }) {
    const sizes = [];
    for (const [width, deviceScaleFactor] of [[900, 1], [700, 1], [700, 2], [700, 1.5], [700, 1]]) {
        await tab("Emulation.setDeviceMetricsOverride", {
            width,
            height: 900,
            deviceScaleFactor,
            mobile: false,
        });
        // Chromium tells media queries of an emulated density when another medium changes, too.
        await tab("Emulation.setEmulatedMedia", {
            features: [
                { name: "prefers-color-scheme", value: "light" },
                { name: "prefers-reduced-motion", value: sizes.length % 2 ? "reduce" : "no-preference" },
            ],
        });
        await evaluate("settled().then(settled)");
        sizes.push(await evaluate("[canvas.width, canvas.clientWidth * devicePixelRatio]"));
    }
    await tab("Emulation.clearDeviceMetricsOverride");
    await evaluate("settled()");
    return sizes;
}

// The colours along the middle of the picture, each where it covers some pixels of bodies.
const coloursOfRow = `(async () => {
    const middle = () => {
        const { width, height } = canvas;
        return pixels().slice((height >> 1) * width, ((height >> 1) + 1) * width);
    };
    await choose("colouring", "height");
    const other = middle();
    await choose("colouring", "cell");
    const row = middle();
    const colours = [];
    for (let at = 0, end; at < row.length; at = end) {
        for (end = at + 1; end < row.length && row[end] === row[at]; ++end) {}
        if (end - at >= 4 && row[at] !== other[at]) {
            colours.push(row[at]);
        }
    }
    return colours;
})()`;

async function inShort({ tab, evaluate }) {
    await scheme(tab, "light");
    const seen = { state: await evaluate(ready) };
    await evaluate(helpers);
    await evaluate("settled()");
    const textOf = (place) => evaluate(`root.querySelector("${place}").textContent`);
    seen.frames = await evaluate(allFrames);
    seen.lines = Number((await evaluate("choose('pairs', true)")).lines);
    await evaluate("choose('pairs', false)");
    await evaluate("canvas.focus()");
    for (const key of [..."123456"].map(() => "ArrowLeft").concat([..."12345"].map(() => "ArrowDown"))) {
        await press(tab, key); // until the camera looks along z
    }
    await evaluate("choose('cellSize', '1')");
    seen.colours = await evaluate(coloursOfRow);
    seen.counts = await textOf(".counts");
    seen.played = await pictureAfter(evaluate, () => press(tab, " "));
    return seen;
}

async function withWebGL2({ tab, evaluate }) {
    await scheme(tab, "light");
    const seen = { state: await evaluate(ready) };
    await evaluate(helpers);
    await evaluate("settled()");
    seen.cells = await evaluate(`({
        size: Number(root.querySelector("[name=cellSize]").value),
        legend: root.querySelector(".legend").textContent,
    })`);
    seen.keysElsewhere = await byKeysElsewhere({ tab, evaluate });
    seen.loss = await evaluate(lossOfContext);
    seen.screens = await onScreens({ tab, evaluate });
    seen.frames = await evaluate(allFrames);
    seen.changes = await evaluate(changes);
    seen.inks = [await evaluate("pixels()[0]")];
    await pictureAfter(evaluate, () => scheme(tab, "dark"));
    seen.inks.push(await evaluate("pixels()[0]"));
    seen.keys = await byKeys({ tab, evaluate });
    seen.framesASecond = await evaluate(framesASecond);
    await evaluate("scrub(0)");
    await pictureAfter(evaluate, () => press(tab, "w"));
    seen.wrongPair = await evaluate(wrongPair);
    return seen;
}

const withoutWebGL2 = async ({ evaluate }) => ({
    state: await evaluate(ready),
    canvases: await evaluate(`document.querySelectorAll("canvas").length`),
    words: await evaluate(`document.querySelector("div.replay > p").textContent`),
});

const hideWebGL2 = (tab) =>
    tab("Page.addScriptToEvaluateOnNewDocument", {
        source: "HTMLCanvasElement.prototype.getContext = () => null;",
    });

const [chromium, ...pages] = process.argv.slice(2);
const browser = new Browser(
    chromium,
    ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=900,900"],
    180,
);
const seen = [];
const fragment = "#replay";
const [whole, ...small] = pages;
seen.push({
    withWebGL2: await browser.inTab(whole, { fragment }, withWebGL2),
    withoutWebGL2: await browser.inTab(whole, { fragment, setUp: hideWebGL2 }, withoutWebGL2),
});
for (const page of small) {
    seen.push(await browser.inTab(page, { fragment }, inShort));
}
console.log(JSON.stringify(seen, null, 1));
await browser.close();
