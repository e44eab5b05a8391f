// SPDX-License-Identifier: Zlib
//
// Shows one of the page's tabs at a time, by the pattern of the ARIA Authoring Practices: arrows, Home
// and End go from tab to tab. Links and addresses lead to the tab that holds what they name.

const list = document.querySelector("[role=tablist]");
const tabs = [...list.querySelectorAll("[role=tab]")];
const panelOf = (tab) => document.getElementById(tab.getAttribute("aria-controls"));

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

function followAddress() {
    const target = document.getElementById(location.hash.slice(1));
    const tab = target && tabs.find((each) => panelOf(each).contains(target));
    if (tab) {
        select(tab);
        if (target !== panelOf(tab)) {
            target.scrollIntoView();
        }
    }
    return Boolean(tab);
}

list.addEventListener("click", (event) => {
    const tab = event.target.closest("[role=tab]");
    if (tab) {
        selectAndTell(tab);
    }
});
list.addEventListener("keydown", (event) => {
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
addEventListener("hashchange", followAddress);
list.hidden = false;
if (!followAddress()) {
    select(tabs[0]);
}
