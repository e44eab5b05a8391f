// SPDX-License-Identifier: Zlib
//
// Moves about in a page: links and addresses open what holds their target, tabs are shown one at a time, boxes that
// scroll sideways say so, and all folds are open on paper.

const list = document.querySelector("[role=tablist]");
const tabs = [...(list?.querySelectorAll("[role=tab]") ?? [])];
const panelOf = (tab) => document.getElementById(tab.getAttribute("aria-controls"));

// --- Tabs, by the pattern of the ARIA Authoring Practices: arrows, Home and End go from tab to tab ----

function select(chosen) {
    for (const tab of tabs) {
        const isChosen = tab === chosen;
        tab.setAttribute("aria-selected", String(isChosen));
        tab.tabIndex = isChosen ? 0 : -1;
        panelOf(tab).hidden = !isChosen;
    }
    panelOf(chosen).dispatchEvent(new Event("tabshown"));
}

// Without a jump to the panel's top.
function selectAndTell(tab) {
    select(tab);
    history.replaceState(null, "", `#${panelOf(tab).id}`);
}

list?.addEventListener("click", (event) => {
    const tab = event.target.closest("[role=tab]");
    if (tab) {
        selectAndTell(tab);
    }
});
list?.addEventListener("keydown", (event) => {
    const at = tabs.indexOf(document.activeElement);
    const next = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: tabs.length - 1 }[
        event.key
    ];
    if (at >= 0 && next !== undefined) {
        event.preventDefault();
        const tab = tabs[(next + tabs.length) % tabs.length];
        selectAndTell(tab);
        tab.focus();
    }
});

// --- Targets --------------------------------------------------------------------------------------

// Shows the target of the address: its tab, and what is folded up in it or around it. Returns its tab.
function followAddress() {
    const target = document.getElementById(location.hash.slice(1));
    const tab = target && tabs.find((each) => panelOf(each).contains(target));
    if (tab) {
        select(tab);
    }
    let fold = target && (target.querySelector(":scope > details") ?? target).closest("details");
    for (; fold; fold = fold.parentElement.closest("details")) {
        fold.open = true;
    }
    if (target && !tabs.some((each) => panelOf(each) === target)) {
        target.scrollIntoView();
    }
    return tab;
}

addEventListener("hashchange", followAddress);
document.addEventListener("click", (event) => {
    if (event.target.closest("a")?.getAttribute("href") === location.hash) {
        followAddress(); // the address stays as it is, and a fold may have been closed since
    }
});

// --- Paper, and boxes that scroll -------------------------------------------------------------------

addEventListener("beforeprint", () => {
    const folds = [...document.querySelectorAll("details:not([open])")];
    folds.forEach((fold) => (fold.open = true));
    addEventListener("afterprint", () => folds.forEach((fold) => (fold.open = false)), { once: true });
});

const watch = new ResizeObserver((entries) => {
    for (const { target } of entries) {
        const scrolls = target.scrollWidth > target.clientWidth;
        target.classList.toggle("scrolls", scrolls);
        scrolls ? target.setAttribute("tabindex", "0") : target.removeAttribute("tabindex"); // for the keyboard
    }
});
document.querySelectorAll(".table, .drawing").forEach((box) => watch.observe(box));

if (list) {
    list.hidden = false;
}
if (!followAddress() && list) {
    select(tabs[0]);
}
