// SPDX-License-Identifier: Zlib
//
// node browse.mjs <chromium> <page>...
//
// Opens pages in headless Chromium, with JavaScript on and off, and tells as JSON, page by page, what
// was drawn, what went wrong, what can be read, and how it prints. Talks the DevTools protocol over a
// pipe: https://chromedevtools.github.io/devtools-protocol/

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
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

const whatIsDrawn = `(async () => {
    while (document.documentElement.dataset.charts !== "done") {
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
    return [...document.querySelectorAll("figure")].map((figure) => {
        const svg = figure.querySelector(".drawing svg");
        return {
            name: figure.id,
            drawn: figure.dataset.drawn,
            marks: svg ? svg.querySelectorAll(".mark-symbol path, .mark-rect path, .mark-line path").length : 0,
            notNumbers: svg ? (svg.outerHTML.match(/NaN|Infinity|undefined/g) ?? []).length : 0,
            text: svg ? [...svg.querySelectorAll("text")].map((each) => each.textContent).join("|") : "",
        };
    });
})()`;

async function look(path) {
    const drawn = await inTab(path, true, async ({ tab, evaluate }) => {
        const charts = await evaluate(whatIsDrawn);
        const evalIsRefused = await evaluate(
            "(() => { const s = document.createElement('script'); s.textContent = 'window.ran = 1';" +
            " document.body.append(s); return !window.ran; })()");
        const { data } = await tab("Page.printToPDF");
        return { charts, evalIsRefused, pdf: Buffer.from(data, "base64").subarray(0, 4).toString(), pdfBytes: data.length };
    });
    return { drawn };
}

try {
    const seen = [];
    for (const page of pages) {
        seen.push(await look(page));
    }
    console.log(JSON.stringify(seen, null, 1));
} finally {
    browser.kill();
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
}
