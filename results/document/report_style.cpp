#include "results/document/report_style.hpp"

namespace mpm {

const char* const kReportStyle = R"(
:root { --ink: #1b1f24; --soft: #59636e; --rule: #d5dbe1; --wash: #f4f6f8; --blue: #0072b2;
  --good: #00704f; --bad: #b34700; --page: #fff; --warn: #fdf0e6; --mark: #fff3c4; color-scheme: light; }
@media screen and (prefers-color-scheme: dark) {
  :root:not([data-theme=light]) { --ink: #e6e9ec; --soft: #a2acb6; --rule: #39424c; --wash: #20262d; --blue: #6cb6e8; --good: #4fc79a;
    --bad: #ff9d5c; --page: #14181c; --warn: #33241a; --mark: #4a3f14; color-scheme: dark; }
  :root:not([data-theme=light]) figure svg { filter: invert(1) hue-rotate(180deg); }
}
@media screen {
  :root[data-theme=dark] { --ink: #e6e9ec; --soft: #a2acb6; --rule: #39424c; --wash: #20262d; --blue: #6cb6e8; --good: #4fc79a;
    --bad: #ff9d5c; --page: #14181c; --warn: #33241a; --mark: #4a3f14; color-scheme: dark; }
  :root[data-theme=dark] figure svg { filter: invert(1) hue-rotate(180deg); }
}
.panels svg > g > rect:first-child { fill: none; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; scroll-behavior: smooth; }
@media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
body { margin: 0 auto; max-width: 68rem; padding: 2.5rem 1.5rem 4rem; color: var(--ink); background: var(--page);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
h1, h2 { line-height: 1.2; letter-spacing: -0.01em; }
h1 { font-size: clamp(1.4rem, 1.1rem + 1.4vw, 1.9rem); margin: 0.2rem 0 0.6rem; max-width: 56rem; }
h2 { font-size: 1.35rem; margin: 0 0 0.9rem; }
h2 .index { color: var(--soft); font-weight: 400; margin-right: 0.5em; font-variant-numeric: tabular-nums; }
section { margin-top: 3.2rem; padding-top: 1.6rem; border-top: 1px solid var(--rule); }
p { max-width: 46rem; margin: 0 0 1rem; }
a { color: var(--blue); text-underline-offset: 0.15em; }
small { color: var(--soft); font-size: 0.85em; }
sub { font-size: 0.72em; line-height: 0; }
code { font: 0.85em/1.4 ui-monospace, SFMono-Regular, Menlo, Consolas, "Liberation Mono", monospace;
  background: var(--wash); padding: 0.1em 0.35em; border-radius: 3px; overflow-wrap: anywhere; }
.eyebrow { margin: 0; color: var(--soft); font-size: 0.85rem; letter-spacing: 0.06em; text-transform: uppercase; }
nav ol { columns: 16rem auto; column-gap: 2rem; margin: 1.4rem 0 0; padding: 0; list-style: none;
  font-size: 0.95rem; }
nav li { break-inside: avoid; padding: 0.15rem 0; display: flex; gap: 0.6em; }
nav li span { color: var(--soft); min-width: 1.3em; text-align: right; font-variant-numeric: tabular-nums; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(14.5rem, 1fr)); gap: 1.1rem 2rem; margin: 0 0 1.5rem; }
.facts dt { color: var(--soft); font-size: 0.8rem; letter-spacing: 0.04em; text-transform: uppercase; }
.facts dd { margin: 0.1rem 0 0; line-height: 1.4; }
#verdict > .facts { grid-template-columns: 1fr; max-width: 50rem; padding: 0.9rem 1.2rem;
  border-left: 4px solid var(--blue); background: var(--wash); }
.fold summary { cursor: pointer; font-weight: 500; }
.verdict { max-width: 50rem; margin: 1.2rem 0; padding: 0.9rem 1.2rem; border-left: 4px solid var(--blue);
  background: var(--wash); font-size: 1.05rem; }
.verdict p { margin: 0 0 0.5rem; max-width: none; }
.verdict p:last-child { margin: 0; }
.answer { font-size: 1.08rem; font-weight: 500; }
.theme { float: right; }
button { font: inherit; color: inherit; background: none; border: 1px solid var(--rule); border-radius: 4px;
  padding: 0.15rem 0.6rem; cursor: pointer; }
:is(a, button, input, tr):focus-visible { outline: 2px solid var(--blue); outline-offset: 2px; }
th button { border: 0; padding: 0; font-weight: inherit; text-align: inherit; }
th button::after { content: " \2195"; color: var(--soft); font-weight: 400; }
th[aria-sort=ascending] button::after { content: " \2191"; color: var(--ink); }
th[aria-sort=descending] button::after { content: " \2193"; color: var(--ink); }
.filter { display: block; margin: 0 0 0.5rem; color: var(--soft); font-size: 0.9rem; }
.filter input { font: inherit; color: var(--ink); background: var(--page); border: 1px solid var(--rule);
  border-radius: 4px; padding: 0.2rem 0.5rem; width: min(16rem, 60%); }
tr:target > *, tr:focus > *, .loop:target h3 { background: var(--mark); }
.loop { margin: 0 0 2.2rem; }
.loop h3 { font-size: 1.05rem; margin: 0 0 0.5rem; }
.glossary { font-size: 0.86rem; line-height: 1.4; margin-top: 3rem; }
.glossary h2 { font-size: 1rem; margin: 0 0 0.6rem; }
.glossary dl { margin: 0; columns: 18rem auto; column-gap: 2rem; }
.glossary div { break-inside: avoid; padding: 0 0 0.6rem; }
.glossary div:target dt { background: var(--mark); }
.glossary dt { font-weight: 600; }
.glossary dd { margin: 0; color: var(--soft); }
.check { max-width: none; padding: 0.7rem 1rem; border-left: 4px solid; background: var(--wash); }
.check.passed { border-color: #009e73; }
.check.failed { border-color: #d55e00; background: var(--warn); }
.absent { color: var(--soft); font-style: italic; }
.table { margin: 0 0 1.6rem; }
.caption { color: var(--soft); font-size: 0.92rem; margin: 0 0 0.4rem; }
.scroll { overflow-x: auto; -webkit-overflow-scrolling: touch; }
.scroll:focus-visible { outline: 2px solid var(--blue); outline-offset: 2px; }
table { border-collapse: collapse; font-size: 0.9rem; line-height: 1.35; font-variant-numeric: tabular-nums; }
th, td { padding: 0.36rem 0.65rem; text-align: left; vertical-align: top; border-bottom: 1px solid var(--rule); }
th:first-child, td:first-child { padding-left: 0.3rem; }
td.number, th.number { text-align: right; white-space: nowrap; }
td.number .wraps { white-space: normal; }
thead th { border-bottom: 1.5px solid var(--ink); vertical-align: bottom; font-weight: 600; }
thead th.number { white-space: normal; }
tbody th { font-weight: 400; }
tr.group th { padding-top: 1rem; font-weight: 600; border-bottom-color: var(--ink); }
tr.sum > * { border-bottom: 0; border-top: 1.5px solid var(--ink); }
td .none { color: var(--soft); }
.yes { color: var(--good); }
.no { color: var(--bad); font-weight: 600; }
.matrices { display: grid; gap: 0 2.5rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); }
.matrices .caption { color: var(--ink); font-weight: 600; }
.matrix th, .matrix td { padding: 0.36rem 0.5rem; }
.matrix .interval { color: var(--soft); }
.matrix .zero { color: #98a1aa; }
td.text { min-width: 15.5rem; }
td code { white-space: nowrap; }
figure { margin: 0 0 1.8rem; }
figcaption { color: var(--soft); font-size: 0.92rem; max-width: 50rem; margin: 0.6rem 0 0; }
.legend { display: flex; flex-wrap: wrap; gap: 0.25rem 1.4rem; margin: 0 0 0.4rem; padding: 0; list-style: none;
  font-size: 0.9rem; }
.legend li { display: inline-flex; align-items: center; gap: 0.45rem; }
.legend svg { flex: none; width: 30px; height: 14px; }
.panels { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); gap: 0.8rem 1.5rem; }
.panels.one { max-width: 33rem; }
.panels svg { display: block; width: 100%; height: auto; }
.panels svg text, .panels svg tspan { font-family: system-ui, -apple-system, "Segoe UI", Roboto,
  "Helvetica Neue", Arial, sans-serif; }
.point:hover use { stroke: #000; stroke-width: 0.5; }
footer { margin-top: 3.5rem; padding-top: 1rem; border-top: 1px solid var(--rule); color: var(--soft); font-size: 0.88rem; }
@media screen and (min-width: 78rem) {
  body:has(.glossary) { max-width: 78rem; display: grid; grid-template-columns: minmax(0, 1fr) 13rem; column-gap: 2.5rem; }
  body:has(.glossary) > :is(header, footer) { grid-column: 1 / -1; }
  .glossary { position: sticky; top: 1.5rem; align-self: start; max-height: calc(100vh - 3rem); overflow-y: auto;
    margin-top: 4.8rem; }
  .glossary dl { columns: auto; }
}
@media (hover: none) { .hint { display: none; } }
@media (max-width: 40rem) {
  body { padding: 1.4rem 1rem 3rem; }
  section { margin-top: 2.2rem; padding-top: 1.2rem; }
  table { font-size: 0.84rem; }
  th, td { padding: 0.32rem 0.4rem; }
  .facts { grid-template-columns: 1fr; gap: 0.8rem; }
  tbody th { position: sticky; left: 0; background: var(--page); min-width: 2.2rem; }
  tbody th:not(.number) { min-width: 5rem; }
  td.text { min-width: 10rem; }
  .matrix tbody th { min-width: 0; }
}
@media print {
  @page { size: A4; margin: 16mm 14mm; }
  html { scroll-behavior: auto; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav, .hint, .theme, .filter, th button::after { display: none; }
  section { margin-top: 1.4rem; padding-top: 0.8rem; }
  h2, .caption, .legend { break-after: avoid; }
  figure { break-inside: avoid; }
  .panels { grid-template-columns: 1fr 1fr; gap: 0.4rem 0.8rem; }
  .panels.one { grid-template-columns: 1fr; max-width: 120mm; }
  .panels svg, tr, .check, .facts div { break-inside: avoid; }
  .matrices { grid-template-columns: 1fr; }
  .scroll { overflow: visible; }
  .table:not(:has(tr:nth-child(12))) { break-inside: avoid; }
  table { font-size: 7.2pt; }
  th, td { padding: 0.14rem 0.28rem; }
  thead { display: table-header-group; }
  td code { font-size: 6.2pt; padding: 0; background: none; }
  td.text { min-width: 50mm; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)";

}  // namespace mpm
