// SPDX-License-Identifier: Zlib
//
// node browse.mjs <chromium> <page>...
//
// Opens pages in headless Chromium, with JavaScript on and off, and tells as JSON, page by page, what
// was drawn, what went wrong, what can be read, and how it prints. Talks the DevTools protocol over a
// pipe: https://chromedevtools.github.io/devtools-protocol/

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [chromium, ...pages] = process.argv.slice(2);
const profile = mkdtempSync(join(tmpdir(), "hashphase-browse-"));
const browser = spawn(
    chromium,
    ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
        "--disable-background-networking", "--remote-debugging-pipe", `--user-data-dir=${profile}`],
    { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] },
);
const [toBrowser, fromBrowser] = browser.stdio.slice(3);

const answers = new Map(); // by the number of the call
const listeners = new Set(); // told of every event
let calls = 0;
let rest = "";
fromBrowser.setEncoding("utf8").on("data", (text) => {
    const messages = (rest + text).split("\0");
    rest = messages.pop();
    for (const message of messages.map((each) => JSON.parse(each))) {
        if (answers.has(message.id)) {
            const { resolve, reject } = answers.get(message.id);
            answers.delete(message.id);
            message.error ? reject(new Error(message.error.message)) : resolve(message.result);
        } else {
            listeners.forEach((tell) => tell(message));
        }
    }
});

function call(sessionId, method, params = {}) {
    return new Promise((resolve, reject) => {
        answers.set(++calls, { resolve, reject });
        toBrowser.write(JSON.stringify({ id: calls, sessionId, method, params }) + "\0");
    });
}

// Runs what is to be done with a page in a tab of its own; `faults` collects what goes wrong in it.
async function inTab(path, javaScript, task) {
    const { targetId } = await call(undefined, "Target.createTarget", { url: "about:blank" });
    const { sessionId } = await call(undefined, "Target.attachToTarget", { targetId, flatten: true });
    const tab = (method, params) => call(sessionId, method, params);
    const faults = [];
    const requests = [];
    let loaded;
    const whenLoaded = new Promise((resolve) => (loaded = resolve));
    const listen = (event) => {
        if (event.sessionId !== sessionId) {
            return;
        }
        if (event.method === "Page.loadEventFired") {
            loaded();
        } else if (event.method === "Runtime.exceptionThrown") {
            const { text, exception } = event.params.exceptionDetails;
            faults.push(exception?.description ?? text);
        } else if (event.method === "Log.entryAdded") {
            faults.push(event.params.entry.text); // breaches of the content-security policy among them
        } else if (event.method === "Runtime.consoleAPICalled") {
            faults.push(`${event.params.type}: ${event.params.args.map((each) => each.value).join(" ")}`);
        } else if (event.method === "Network.requestWillBeSent") {
            requests.push(event.params.request.url.slice(0, 80));
        }
    };
    listeners.add(listen);
    for (const domain of ["Page", "Runtime", "Log", "Network"]) {
        await tab(`${domain}.enable`);
    }
    await tab("Emulation.setScriptExecutionDisabled", { value: !javaScript });
    await tab("Page.navigate", { url: pathToFileURL(path).href });
    await whenLoaded;
    const evaluate = async (expression) =>
        (await tab("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true })).result.value;
    const result = await task({ tab, evaluate });
    listeners.delete(listen);
    await call(undefined, "Target.closeTarget", { targetId });
    return { ...result, faults, requests };
}

// What there is to see once all charts are drawn.
const charts = `(async () => {
    while (document.documentElement.dataset.charts !== "done") {
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
    return [...document.querySelectorAll("figure")].map((figure) => {
        const svg = figure.querySelector(".drawing svg");
        return {
            name: figure.id,
            drawn: figure.dataset.drawn,
            points: svg?.querySelectorAll(".mark-symbol.role-mark path").length,
            bars: svg?.querySelectorAll(".mark-rect.role-mark path").length,
            lines: svg?.querySelectorAll(".mark-line.role-mark path").length,
            texts: [...(svg?.querySelectorAll("text") ?? [])].map((each) => each.textContent),
            broken: svg?.outerHTML.match(/NaN|Infinity|undefined/g)?.length ?? 0,
        };
    });
})()`;

const ink = `getComputedStyle(document.querySelector(".drawing svg text") ?? document.body).fill`;

const firstPoint = `(() => {
    const point = document.querySelector(".drawing .mark-symbol.role-mark path, .drawing .mark-rect.role-mark path");
    point?.scrollIntoView({ block: "center" });
    const { x = 0, y = 0, width = 0, height = 0 } = point?.getBoundingClientRect() ?? {};
    return { x: x + width / 2, y: y + height / 2 };
})()`;

const tooltip = `document.querySelector("#vg-tooltip-element.visible")?.textContent ?? ""`;

// A script that the page did not bring along, as an attacker's data would be.
const runForeignScript = `(() => {
    const script = document.createElement("script");
    script.textContent = "window.foreignScriptRan = true";
    document.body.append(script);
    return window.foreignScriptRan === true;
})()`;

const withoutScripts = `({
    rows: document.querySelectorAll("tbody tr").length,
    drawings: document.querySelectorAll("svg").length,
    notice: document.querySelector("noscript p")?.innerText,
})`;

async function print(tab) {
    const { data } = await tab("Page.printToPDF");
    return { begin: data && Buffer.from(data, "base64").toString("latin1", 0, 4), bytes: data.length };
}

async function scheme(tab, name) {
    await tab("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: name }] });
}

async function withJavaScript({ tab, evaluate }) {
    const seen = { charts: await evaluate(charts), inks: [] };
    for (const name of ["light", "dark"]) {
        await scheme(tab, name);
        seen.inks.push(await evaluate(ink));
    }
    await tab("Input.dispatchMouseEvent", { type: "mouseMoved", ...(await evaluate(firstPoint)) });
    seen.tooltip = await evaluate(tooltip);
    seen.pdf = await print(tab);
    seen.foreignScriptRan = await evaluate(runForeignScript);
    return seen;
}

async function withoutJavaScript({ tab, evaluate }) {
    return { ...(await evaluate(withoutScripts)), pdf: await print(tab) };
}

const gone = new Promise((resolve) => browser.once("exit", resolve));
const tooLong = setTimeout(() => {
    console.error("The browser did not answer in time.");
    browser.kill("SIGKILL");
    process.exit(1);
}, 120_000);
browser.once("error", (error) => {
    console.error(error.message);
    process.exit(1);
});

const seen = [];
for (const page of pages) {
    seen.push({
        withJavaScript: await inTab(page, true, withJavaScript),
        withoutJavaScript: await inTab(page, false, withoutJavaScript),
    });
}
console.log(JSON.stringify(seen, null, 1));
clearTimeout(tooLong);
await call(undefined, "Browser.close");
await gone;
rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
