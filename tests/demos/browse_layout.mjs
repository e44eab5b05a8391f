// SPDX-License-Identifier: Zlib
//
// node browse_layout.mjs <chromium> <joined page> <page>...
//
// Looks in headless Chromium at how pages are laid out, on a wide screen and on a narrow one, and fails where it is
// not as it is to be: nothing is wider than the screen but what scrolls in a box of its own, which says so; labels of
// axes are apart; the contents' links unfold their targets; paper has all that is folded up.

import assert from "node:assert/strict";
import { Browser } from "./browser.mjs";

const helpers = `
    window.frames = async () => {
        await new Promise(requestAnimationFrame);
        await new Promise(requestAnimationFrame);
    };
    window.drawn = async () => {
        await frames();
        while (document.documentElement.dataset.charts !== "done") {
            await new Promise((resolve) => setTimeout(resolve, 20));
        }
        await frames();
    };
    window.named = (element) => element.tagName + "#" + (element.closest("[id]")?.id ?? "") + "." + element.className
        + ": " + element.textContent.trim().slice(0, 60);
`;

const unfoldAll = `(async () => {
    await drawn();
    document.querySelectorAll("details").forEach((fold) => (fold.open = true));
    await drawn();
})()`;

// What ends beyond the screen, and is in no box that scrolls.
const tooWide = `[...document.body.querySelectorAll("*")].filter((element) => {
    const { right, left, width } = element.getBoundingClientRect();
    const box = element.closest(".table, .drawing");
    const isInBox = box && box !== element && box.scrollWidth > box.clientWidth;
    return width > 0 && !isInBox && (right > document.documentElement.clientWidth + 0.5 || left < -0.5);
}).map(named)`;

const labelsThatOverlap = `[...document.querySelectorAll(".drawing svg")].flatMap((svg) => {
    const texts = [...svg.querySelectorAll(".role-axis-label text, .role-axis-title text")]
        .filter((text) => text.textContent !== "" && getComputedStyle(text).opacity !== "0");
    const boxes = texts.map((text) => text.getBoundingClientRect());
    const pairs = [];
    for (let i = 0; i < boxes.length; ++i) {
        for (let j = i + 1; j < boxes.length; ++j) {
            const [a, b] = [boxes[i], boxes[j]];
            const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
            const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
            if (across > 1 && down > 2) { // lines of text reach into each other by their empty margins
                pairs.push(svg.closest("figure").id + ": " + texts[i].textContent + " / " + texts[j].textContent);
            }
        }
    }
    return pairs;
})`;

// Boxes that scroll and do not say so, or say so and do not.
const silentBoxes = `[...document.querySelectorAll(".table, .drawing")].filter((box) => {
    const scrolls = box.scrollWidth > box.clientWidth;
    const hint = getComputedStyle(box, "::before").content;
    return scrolls !== hint.includes("scroll") || scrolls !== (box.tabIndex === 0);
}).map(named)`;

const shares = `(() => {
    const { clientWidth } = document.documentElement;
    const content = document.querySelector(".content").getBoundingClientRect();
    const svgs = [...document.querySelectorAll(".drawing svg")].map((svg) =>
        svg.getBoundingClientRect().width / svg.closest(".drawing").clientWidth);
    return {
        overflow: document.body.scrollWidth - document.body.clientWidth,
        content: content.width / clientWidth,
        narrowest: Math.min(...svgs),
        boxes: document.querySelectorAll(".scrolls").length,
        svgs: svgs.length,
    };
})()`;

const size = (width) => (tab) =>
    tab("Emulation.setDeviceMetricsOverride", { width, height: 900, deviceScaleFactor: 1, mobile: false });

const checkLayout = (width) => async ({ evaluate }) => {
    await evaluate(helpers);
    await evaluate(unfoldAll);
    assert.deepEqual(await evaluate(tooWide), [], `at ${width} pixels`);
    assert.deepEqual(await evaluate(labelsThatOverlap), [], `at ${width} pixels`);
    assert.deepEqual(await evaluate(silentBoxes), [], `at ${width} pixels`);
    const seen = await evaluate(shares);
    assert(seen.overflow <= 0, `the body is ${seen.overflow} pixels too wide`);
    assert(seen.content > (width > 1000 ? 0.7 : 0.9), `${seen.content} of the screen for the report`);
    assert(seen.svgs === 0 || seen.narrowest > 0.98, `a chart has ${seen.narrowest} of its box`);
    return seen;
};

async function checkResizing({ tab, evaluate }) {
    await evaluate(helpers);
    await evaluate("drawn()");
    await size(700)(tab);
    await evaluate(unfoldAll);
    assert((await evaluate(shares)).narrowest > 0.98, "charts follow the window");
    assert.deepEqual(await evaluate(tooWide), []);
}

const follow = (link) => `(async () => {
    document.querySelector('.contents a[href="#${link}"]').click();
    await frames();
    const target = document.getElementById("${link}");
    return { isOpen: target.querySelector("details").open, top: target.getBoundingClientRect().top };
})()`;

async function checkFolds({ tab, evaluate }) {
    await evaluate(helpers);
    await evaluate("drawn()");
    const folds = await evaluate(`[...document.querySelectorAll(".fold")].map((fold) => fold.open)`);
    assert(folds.length >= 4 && !folds.includes(true), "folded up at first");
    for (let i = 0; i < 2; ++i) { // the second time the address is there already
        const { isOpen, top } = await evaluate(follow("part-2-section-0"));
        assert(isOpen && Math.abs(top) < 450, `unfolded: ${isOpen}, ${top} pixels from the top`);
        await evaluate(`document.querySelector("#part-2-section-0 details").open = false`);
    }
    await tab("Emulation.setEmulatedMedia", { media: "print" });
    await evaluate("frames()");
    const hidden = await evaluate(`[...document.querySelectorAll(".fold > p, .fold > summary > h3, figure details table")]
        .filter((element) => !element.checkVisibility()).map(named)`);
    assert.deepEqual(hidden, [], "on paper");
    assert.equal(await evaluate(`getComputedStyle(document.querySelector(".contents")).display`), "none");
    await tab("Emulation.setEmulatedMedia", { media: "" });
    await evaluate(`dispatchEvent(new Event("beforeprint"))`);
    assert.equal(await evaluate(`document.querySelectorAll("details:not([open])").length`), 0);
    await evaluate(`dispatchEvent(new Event("afterprint"))`);
    assert.equal(await evaluate(`document.querySelectorAll(".fold[open]").length`), 0);
}

// Where the address of the page is that of a section.
async function checkAddress({ evaluate }) {
    await evaluate(helpers);
    assert.equal(await evaluate(`document.querySelector("#part-2-section-0 details").open`), true);
    assert.equal(await evaluate(`document.querySelector("#part-1-section-0 details").open`), false);
}

const [chromium, joined, ...others] = process.argv.slice(2);
const browser = new Browser(chromium, ["--disable-gpu"], 240);
const check = async (path, task, options = {}) => {
    const { faults, ...seen } = await browser.inTab(path, options, async (page) => (await task(page)) ?? {});
    assert.deepEqual(faults, []);
    return seen;
};
let boxes = 0;
try {
    for (const page of [joined, ...others]) {
        for (const width of [1280, 400]) {
            const seen = await check(page, checkLayout(width), { setUp: size(width) });
            boxes += width === 400 ? seen.boxes : 0;
        }
    }
    assert(boxes > 0, "some tables are wider than the narrow screen");
    await check(joined, checkResizing, { setUp: size(1280) });
    await check(joined, checkFolds, { setUp: size(1280) });
    await check(joined, checkAddress, { setUp: size(1280), fragment: "#part-2-section-0" });
} finally {
    await browser.close();
}
