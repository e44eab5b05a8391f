// SPDX-License-Identifier: Zlib
//
// node browse_replay.mjs <chromium> <page>...
//
// Plays the recordings of pages in headless Chromium, whose WebGL2 is drawn by the processor, and tells
// as JSON, page by page, what was to be seen in each frame, how the picture changes with what is chosen,
// where the first wrong pair is, how fast it draws, and what is said where there is no WebGL2.

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

async function withWebGL2({ tab, evaluate }) {
    await scheme(tab, "light");
    const seen = { state: await evaluate(ready) };
    await evaluate(helpers);
    await evaluate("settled()");
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
for (const page of pages) {
    const fragment = "#replay";
    seen.push({
        withWebGL2: await browser.inTab(page, { fragment }, withWebGL2),
        withoutWebGL2: await browser.inTab(page, { fragment, setUp: hideWebGL2 }, withoutWebGL2),
    });
}
console.log(JSON.stringify(seen, null, 1));
await browser.close();
