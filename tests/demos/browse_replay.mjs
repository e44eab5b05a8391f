// SPDX-License-Identifier: Zlib
//
// node browse_replay.mjs <chromium> <found.json> <page> <row> <heap> <wrong>
//
// Plays the recordings of pages in headless Chromium, whose WebGL2 is drawn by the processor, and fails where it is
// not as it is to be. Of the first page, a comparison that found what is in the file: what it opens on, each frame,
// how the picture changes with what is chosen, keys, the first wrong pair, a loss of WebGL2, other sizes and
// densities of the screen, and the words without WebGL2. Of boxes in a row: their colours, and that no pair is wrong;
// of a heap: too many pairs; of a wrong broadphase alone: what it opens on.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
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
    remember("withGround");
    changed.ground = root.dataset.ground;
    const { ground } = await choose("ground", false);
    changed.withoutGround = ground;
    changed.byGround = changedSince("withGround");
    await choose("ground", true);
    changed.backByGround = changedSince("withGround");
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

// --- What is to be so ----------------------------------------------------------------------------

async function checkKeys({ tab, evaluate }, frames) {
    const after = (key) => pictureAfter(evaluate, () => press(tab, key));
    await evaluate("canvas.focus()");
    await evaluate("scrub(0)");
    assert.equal((await after(".")).frame, 1);
    assert.equal((await after("End")).frame, frames - 1);
    assert.equal((await after("Home")).frame, 0);
    assert.equal((await after("c")).colouring, "height");
    await after("t");
    assert.equal(await evaluate("root.dataset.ground"), "hidden");
    await after("t");
    await evaluate("remember('key')");
    await after("ArrowLeft");
    assert((await evaluate("changedSince('key')")) > 100, "it does not turn");
    assert.equal((await after(" ")).frame, 1, "it does not play");
    await press(tab, " ");
    assert.equal(await evaluate("root.dataset.playing"), "false", "paused by the same key");
}

// Keys that are pressed while the focus is not in the tab's contents.
async function checkKeysElsewhere({ tab, evaluate }) {
    const after = async (key, frame, isPlaying) => {
        await press(tab, key);
        const now = await evaluate("[Number(root.dataset.frame), root.dataset.playing === 'true']");
        assert.deepEqual(now, [frame, isPlaying], `after ${key}`);
    };
    const focus = (what) => evaluate(`scrub(3).then(() => ${what})`);
    await focus("document.getElementById('tab-replay').focus()");
    await after(".", 4, false);
    await after(" ", 4, false); // Space is the tab's own
    await focus("document.activeElement.blur()");
    await after(".", 4, false);
    await after("End", 13, false);
    await after(" ", 13, true);
    await after(" ", 13, false);
    await focus("root.querySelector('[name=cellSize]').focus()");
    await after(".", 3, false);
    await focus("document.getElementById('tab-report').click()");
    await after(",", 3, false);
    await evaluate("document.getElementById('tab-replay').click()");
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
async function checkScreens({ tab, evaluate }) {
    let number = 0;
    for (const [width, deviceScaleFactor] of [[900, 1], [700, 1], [700, 2], [700, 1.5], [700, 1]]) {
        const size = { width, height: 900, deviceScaleFactor, mobile: false };
        await tab("Emulation.setDeviceMetricsOverride", size);
        // Chromium tells media queries of an emulated density when another medium changes, too.
        await tab("Emulation.setEmulatedMedia", {
            features: [
                { name: "prefers-color-scheme", value: "light" },
                { name: "prefers-reduced-motion", value: number++ % 2 ? "reduce" : "no-preference" },
            ],
        });
        await evaluate("settled().then(settled)");
        const [pixels, wanted] = await evaluate("[canvas.width, canvas.clientWidth * devicePixelRatio]");
        assert(Math.abs(pixels - wanted) <= 1, `${pixels} pixels, not ${wanted}`);
    }
    await tab("Emulation.clearDeviceMetricsOverride");
    await evaluate("settled()");
}

async function checkChanges({ tab, evaluate }, found) {
    const changed = await evaluate(changes);
    assert(changed.colours > 100, "an empty picture has few");
    assert.equal(changed.backByCell, 0, "the same picture again, to the last bit");
    assert.deepEqual([changed.ground, changed.withoutGround], ["drawn", "hidden"]);
    assert.equal(changed.backByGround, 0, "the same picture again, to the last bit");
    assert(changed.byGround > 20_000, `the ground covers ${changed.byGround} pixels`);
    for (const change of ["byHeight", "byLargerCell", "byPairs", "byLastFrame"]) {
        assert(changed[change] > 100, change);
    }
    assert.equal(changed.lines, found.frames[0].exactPairs, "all pairs are drawn");
    const ink = await evaluate("pixels()[0]");
    await pictureAfter(evaluate, () => scheme(tab, "dark"));
    assert.notEqual(await evaluate("pixels()[0]"), ink, "on a light and a dark screen");
}

// What it opens on, and the first frame to see of another broadphase.
async function checkOpening({ evaluate }, { frame }) {
    const shown = () => evaluate("[root.dataset.broadphase, Number(root.dataset.frame)]");
    assert.deepEqual(await shown(), ["hash", 0], "ours, from the beginning");
    const counts = () => evaluate("root.querySelector('.counts').textContent");
    assert.match(await counts(), /hash lists exactly these\.$/);
    const faults = await evaluate("root.querySelector('.faults').textContent");
    assert.equal(faults, "Wrong pairs, sum of all recorded frames: forgetful 9 missing; hash 0.");
    assert.equal(await evaluate("root.querySelector('[data-act=showFirst]').hidden"), false);
    await evaluate("choose('broadphase', 'forgetful')");
    assert.deepEqual(await shown(), ["forgetful", frame], "its first wrong frame");
    assert.match(await counts(), /forgetful: 1 missing\.$/);
    await evaluate("choose('broadphase', 'hash')");
    assert.deepEqual(await shown(), ["hash", frame], "in the same frame");
    await evaluate(`scrub(${frame + 2})`);
    await evaluate("choose('broadphase', 'forgetful')");
    assert.deepEqual(await shown(), ["forgetful", frame + 2], "which shows a wrong pair, too");
}

// The mark of the judged broadphase is that of its line in charts.
async function checkMethod({ evaluate }) {
    const mark = (name) => evaluate(`(async () => {
        await choose("broadphase", "${name}");
        const { textContent, style } = root.querySelector(".method");
        return [textContent, style.color];
    })()`);
    assert.deepEqual(await mark("hash"), ["\u25cf", "var(--series-0)"]);
    assert.deepEqual(await mark("forgetful"), ["", ""], "which has no look of its own");
}

async function checkWrongPair({ tab, evaluate }, { frame, objects: [a, b] }) {
    await evaluate("choose('broadphase', 'hash')");
    await evaluate("scrub(0)");
    await pictureAfter(evaluate, () => press(tab, "w"));
    const seen = await evaluate(wrongPair);
    assert.equal(seen.broadphase, "forgetful", "the worst, for ours is right");
    assert.equal(await evaluate("root.querySelector('[name=broadphase]').value"), "forgetful");
    assert.equal(seen.frame, frame);
    assert(seen.words.includes(`Objects ${a} and ${b} overlap`), seen.words);
    assert(seen.inPicture);
    assert.equal(seen.redAtMarks.length, 2);
    for (const red of seen.redAtMarks) {
        assert(red > 20, "pixels in the colour of what is missing");
    }
}

async function begin({ tab, evaluate }) {
    await scheme(tab, "light");
    assert.equal(await evaluate(ready), "ready");
    await evaluate(helpers);
    await evaluate("settled()");
}

const checkAll = (found) => async (page) => {
    const { evaluate } = page;
    await begin(page);
    const legend = await evaluate("root.querySelector('.legend').textContent");
    assert(legend.includes("no broadphase uses this size"), `none has cells: ${legend}`);
    assert(legend.includes("terrain"), legend);
    await checkOpening(page, found.firstFault);
    await checkKeysElsewhere(page);
    const loss = await evaluate(lossOfContext);
    assert.deepEqual(loss.during, { state: "lost", playing: "false" });
    assert.equal(loss.state, "ready", "where WebGL2 comes back");
    assert.equal(loss.changed, 0, "the same picture again, to the last bit");
    await checkScreens(page);
    const frames = found.frames.map(({ exactPairs, missing, extra }, i) => [i, exactPairs, missing, extra]);
    assert.deepEqual(await evaluate(allFrames), frames);
    await checkMethod(page);
    await checkChanges(page, found);
    await checkKeys(page, frames.length);
    console.log("frames a second:", await evaluate(framesASecond));
    await checkWrongPair(page, found.firstFault);
};

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

// Of a recording without wrong pairs and without a ground.
const rightAndLevel = `({
    hasButton: !root.querySelector("[data-act=showFirst]").hidden,
    faults: root.querySelector(".faults").textContent,
    words: root.querySelector(".words").textContent,
    ground: root.dataset.ground,
    hasGroundBox: root.querySelector("[name=ground]") !== null,
    isInLegend: root.querySelector(".legend").textContent.includes("terrain"),
})`;

const checkRow = (bodies) => async (page) => {
    const { tab, evaluate } = page;
    await begin(page);
    await evaluate("canvas.focus()");
    for (const key of [..."123456"].map(() => "ArrowLeft").concat([..."12345"].map(() => "ArrowDown"))) {
        await press(tab, key); // until the camera looks along z
    }
    await evaluate("choose('cellSize', '1')");
    const colours = await evaluate(coloursOfRow);
    assert.equal(colours.length, bodies, `one a body: ${colours}`);
    assert(colours.every((colour, i) => i === 0 || colour !== colours[i - 1]), "cells side by side differ");
    assert.equal((await pictureAfter(evaluate, () => press(tab, " "))).frame, 0, "round and round");
    await press(tab, "w");
    const words = "No broadphase has a wrong pair in the recorded frames.";
    const right = { hasButton: false, faults: words, words };
    const level = { ground: "none", hasGroundBox: false, isInLegend: false };
    assert.deepEqual(await evaluate(rightAndLevel), { ...right, ...level });
};

const checkHeap = (pairs) => async (page) => {
    const { evaluate } = page;
    await begin(page);
    assert.deepEqual((await evaluate(allFrames)).map(([, each]) => each), [pairs]);
    assert.equal((await evaluate("choose('pairs', true)")).lines, "0", "more pairs than are listed");
    const counts = await evaluate("root.querySelector('.counts').textContent");
    assert(counts.startsWith(`Overlapping pairs: ${pairs.toLocaleString("en")}, too many`), counts);
};

// A broadphase that is wrong, and not ours.
async function checkWrong(page) {
    await begin(page);
    const { broadphase, frame, drawn } = await page.evaluate("({ ...root.dataset })");
    assert.deepEqual([broadphase, frame, drawn], ["forgetful", "5", "1"], "its first wrong frame");
}

async function checkWithoutWebGL2({ evaluate }) {
    assert.equal(await evaluate(ready), "without WebGL2");
    assert.equal(await evaluate(`document.querySelectorAll("canvas").length`), 0);
    const words = await evaluate(`document.querySelector("div.replay > p").textContent`);
    assert(words.includes("This browser has no WebGL2"), words);
}

const hideWebGL2 = (tab) =>
    tab("Page.addScriptToEvaluateOnNewDocument", {
        source: "HTMLCanvasElement.prototype.getContext = () => null;",
    });

const [chromium, foundFile, page, row, heap, wrong] = process.argv.slice(2);
const options = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=900,900"];
const browser = new Browser(chromium, options, 180);
const check = async (path, task, setUp) => {
    const { faults, requests } = await browser.inTab(path, { fragment: "#replay", setUp }, task);
    assert.deepEqual(faults, []);
    assert.equal(requests.length, 1, "of the page alone");
};
try {
    await check(page, checkAll(JSON.parse(readFileSync(foundFile, "utf8"))));
    await check(page, checkWithoutWebGL2, hideWebGL2);
    await check(row, checkRow(50));
    await check(heap, checkHeap(150_975));
    await check(wrong, checkWrong);
} finally {
    await browser.close();
}
