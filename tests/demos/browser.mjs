// SPDX-License-Identifier: Zlib
//
// Opens pages in headless Chromium and looks at them, by the DevTools protocol over a pipe:
// https://chromedevtools.github.io/devtools-protocol/

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export class Browser {
    #process;
    #profile = mkdtempSync(join(tmpdir(), "hashphase-browse-"));
    #toBrowser;
    #answers = new Map(); // by the number of the call
    #listeners = new Set(); // told of every event
    #calls = 0;
    #rest = "";
    #tooLong;

    // The program fails when the browser does not answer in time.
    constructor(chromium, options, seconds) {
        this.#process = spawn(
            chromium,
            ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run",
                "--disable-background-networking", "--remote-debugging-pipe",
                `--user-data-dir=${this.#profile}`, ...options],
            { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] },
        );
        const [toBrowser, fromBrowser] = this.#process.stdio.slice(3);
        this.#toBrowser = toBrowser;
        fromBrowser.setEncoding("utf8").on("data", (text) => this.#hear(text));
        this.#process.once("error", (error) => this.#fail(error.message));
        this.#tooLong = setTimeout(() => this.#fail("The browser did not answer in time."), seconds * 1000);
    }

    #fail(message) {
        console.error(message);
        this.#process.kill("SIGKILL");
        process.exit(1);
    }

    #hear(text) {
        const messages = (this.#rest + text).split("\0");
        this.#rest = messages.pop();
        for (const message of messages.map((each) => JSON.parse(each))) {
            if (this.#answers.has(message.id)) {
                const { resolve, reject } = this.#answers.get(message.id);
                this.#answers.delete(message.id);
                message.error ? reject(new Error(message.error.message)) : resolve(message.result);
            } else {
                this.#listeners.forEach((tell) => tell(message));
            }
        }
    }

    call(sessionId, method, params = {}) {
        return new Promise((resolve, reject) => {
            this.#answers.set(++this.#calls, { resolve, reject });
            this.#toBrowser.write(JSON.stringify({ id: this.#calls, sessionId, method, params }) + "\0");
        });
    }

    // Runs what is to be done with a page in a tab of its own; `faults` collects what goes wrong in it.
    // `setUp` is done before the page is loaded, `fragment` is the end of its address.
    async inTab(path, { javaScript = true, setUp = async () => {}, fragment = "" }, task) {
        const { targetId } = await this.call(undefined, "Target.createTarget", { url: "about:blank" });
        const { sessionId } = await this.call(undefined, "Target.attachToTarget", { targetId, flatten: true });
        const tab = (method, params) => this.call(sessionId, method, params);
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
            } else if (event.method === "Network.requestWillBeSent") {
                requests.push(event.params.request.url.slice(0, 80));
            } else {
                faults.push(...faultsIn(event));
            }
        };
        this.#listeners.add(listen);
        for (const domain of ["Page", "Runtime", "Log", "Network"]) {
            await tab(`${domain}.enable`);
        }
        await tab("Emulation.setScriptExecutionDisabled", { value: !javaScript });
        await setUp(tab);
        await tab("Page.navigate", { url: pathToFileURL(path).href + fragment });
        await whenLoaded;
        const evaluate = async (expression) =>
            (await tab("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true })).result.value;
        const result = await task({ tab, evaluate });
        this.#listeners.delete(listen);
        await this.call(undefined, "Target.closeTarget", { targetId });
        return { ...result, faults, requests };
    }

    async close() {
        const gone = new Promise((resolve) => this.#process.once("exit", resolve));
        clearTimeout(this.#tooLong);
        await this.call(undefined, "Browser.close");
        await gone;
        rmSync(this.#profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
    }
}

// What an event tells of what went wrong; breaches of the content-security policy are log entries.
function faultsIn({ method, params }) {
    switch (method) {
        case "Runtime.exceptionThrown":
            return [params.exceptionDetails.exception?.description ?? params.exceptionDetails.text];
        case "Log.entryAdded":
            return [params.entry.text];
        case "Runtime.consoleAPICalled":
            return [`${params.type}: ${params.args.map((each) => each.value).join(" ")}`];
        default:
            return [];
    }
}

export async function scheme(tab, name) {
    await tab("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: name }] });
}
