// SPDX-License-Identifier: Zlib
#include <demos/report/page_style.hpp>

namespace hashphase::demos {

std::string_view pageStyle() {
    return R"css(
:root {
  color-scheme: light dark;
  --ink: #222222; --quiet: #5c5c5c; --faint: #e3e3e3; --paper: #ffffff; --panel: #f5f6f7;
  --link: #0b57a4; --good: #1b6e3c; --bad: #b3261e; --open: #a86500;
  --series-0: #0072b2; --series-1: #d55e00; --series-2: #009e73; --series-3: #cc79a7;
  --series-4: #e69f00; --series-5: #56b4e9; --series-6: #666666;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --ink: #e8e8e8; --quiet: #a9adb3; --faint: #383c42; --paper: #15181c; --panel: #1f2329;
    --link: #8ab8f0; --good: #7fd19b; --bad: #ff8a80; --open: #f0b53c;
    --series-0: #4aa3df; --series-1: #f0824a; --series-2: #2fc79a; --series-3: #e09cc3;
    --series-4: #f0b53c; --series-5: #8fd0f7; --series-6: #a8a8a8;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif;
}
main { max-width: 46rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .5rem; }
h2 { font-size: 1.3rem; line-height: 1.3; margin: 3rem 0 .5rem; }
h3 { font-size: 1.05rem; line-height: 1.35; margin: 0; }
.part { margin-top: 4rem; padding-top: 1rem; border-top: 2px solid var(--faint); }
.part > h2 { font-size: 1.5rem; margin-top: 0; }
.part section > h3 { font-size: 1.3rem; line-height: 1.3; margin: 3rem 0 .5rem; }
h4 { font-size: 1.05rem; line-height: 1.35; margin: 0; }
p, ul { margin: .5rem 0; }
ul { padding-left: 1.3rem; }
a { color: var(--link); }
.verdict {
  border-left: .35rem solid var(--good); background: var(--panel);
  padding: .7rem 1rem; margin: 1rem 0; font-size: 1.1rem;
}
.verdict.bad { border-color: var(--bad); }
.verdict.unchecked { border-color: var(--open); }
.holds, .broken { font-weight: 600; color: var(--good); }
.broken { color: var(--bad); }
.quiet, figcaption p, summary { color: var(--quiet); font-size: .875rem; }
ul.checks { list-style: none; padding: 0; }
ul.checks li { display: flex; margin: .4rem 0; }
ul.checks .holds, ul.checks .broken { flex: 0 0 5rem; }
.contents ul { padding: 0; list-style: none; columns: 17rem; }
.contents > ul > li { break-inside: avoid; }
.contents ul ul { padding-left: 1rem; columns: auto; }
.contents details { margin: 0; }
.tabs { display: flex; gap: .25rem; margin: 1.5rem 0 1rem; border-bottom: 1px solid var(--quiet); }
.tabs[hidden] { display: none; }
.tabs button {
  font: inherit; color: var(--link); background: none; padding: .5rem 1.1rem; cursor: pointer;
  border: 1px solid transparent; border-bottom: 0; border-radius: .4rem .4rem 0 0;
}
.tabs button[aria-selected=true] {
  color: var(--ink); font-weight: 600; background: var(--paper); border-color: var(--quiet);
  margin-bottom: -1px;
}
figure { margin: 2rem 0; }
figcaption p { margin: .15rem 0 .6rem; }
.drawing { overflow-x: auto; }
.drawing svg { max-width: 100%; min-width: 34rem; height: auto; }
details { margin: .4rem 0; }
summary { cursor: pointer; }
.table { overflow-x: auto; margin: .75rem 0; }
table { border-collapse: collapse; font-size: .875rem; line-height: 1.35; }
th, td { text-align: left; vertical-align: top; padding: .3rem .75rem .3rem 0; }
th { vertical-align: bottom; border-bottom: 1px solid var(--quiet); font-weight: 600; }
td { border-bottom: 1px solid var(--faint); font-variant-numeric: tabular-nums; }
.number { text-align: right; }
caption { text-align: left; padding-bottom: .5rem; color: var(--quiet); }
.graded td, .graded th { padding: .2rem .4rem; white-space: nowrap; }
.graded tbody th { vertical-align: top; border-bottom-color: var(--faint); }
.good, .fair, .poor { color: var(--ink); print-color-adjust: exact; }
.good { background: #0072b230; }
.fair { background: #f0e44260; }
.poor { background: #d55e0070; font-weight: 600; }
caption span { padding: .1rem .5rem; }
code { overflow-wrap: anywhere; }
#vg-tooltip-element {
  position: fixed; visibility: hidden; z-index: 1; padding: .4rem .6rem; pointer-events: none;
  background: var(--paper); color: var(--ink); border: 1px solid var(--quiet); font-size: .8rem;
}
#vg-tooltip-element.visible { visibility: visible; }
#vg-tooltip-element td { border: 0; padding: 0 .5rem 0 0; }
#vg-tooltip-element td.key { color: var(--quiet); }
@media (min-width: 80rem) {
  .contents {
    position: fixed; top: 1.5rem; bottom: 1rem; left: calc(50% - 23rem - 15rem); width: 13rem;
    overflow-y: auto; font-size: .875rem;
  }
  .contents ul { columns: auto; }
  .contents li { margin: .3rem 0; line-height: 1.3; }
}
@media print {
  main { max-width: none; padding: 0; }
  .contents, .tabs, summary { display: none; }
  h2, h3, h4 { break-after: avoid; }
  .part { break-before: page; border: 0; margin: 0; padding: 0; }
  .drawing svg { min-width: 0; }
  figcaption, .drawing, tr, li { break-inside: avoid; }
  figcaption { break-after: avoid; }
  body { font-size: 10pt; }
  .table { overflow: visible; }
  details::details-content { content-visibility: visible; display: block; }
}
)css";
}

}  // namespace hashphase::demos
