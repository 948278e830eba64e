// Colours of runs: the hues of Okabe and Ito ("Color universal design", 2008), their lightness spread until,
// with any one kind of cone missing (by the matrices of Machado, Oliveira and Fernandes, "A
// physiologically-based model for simulation of color vision deficiency", 2009), any two of the eight are 13
// apart in CIELAB and any two of the first four 20, and until each stands out from its ground three times to
// one, as WCAG 2.1 (1.4.11) asks of graphics. Letters say the same.
#include "ridgeline/app/report/page_assets.h"

namespace ridgeline::app::report {

const std::string_view kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --ground: #f6f5f2; --card: #ffffff; --ink: #1d2226; --soft: #59636b; --line: #dddbd5; --faint: #eceae5;
  --r0: #0055a5; --r1: #a83800; --r2: #00875a; --r3: #9a5f8c; --r4: #a87400; --r5: #0a84d8; --r6: #3d3d3d; --r7: #4a1914;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --ground: #121518; --card: #1a1e22; --ink: #ebe8e2; --soft: #a0a9b0; --line: #353c42; --faint: #262c31;
    --r0: #3a94f0; --r1: #f0692c; --r2: #1fdca0; --r3: #c07fae; --r4: #f2d84a; --r5: #a5d8f5; --r6: #ffffff; --r7: #a86a50;
  }
}
.r0 { --c: var(--r0) } .r1 { --c: var(--r1) } .r2 { --c: var(--r2) } .r3 { --c: var(--r3) }
.r4 { --c: var(--r4) } .r5 { --c: var(--r5) } .r6 { --c: var(--r6) } .r7 { --c: var(--r7) }
.hide-0 .run.r0, .hide-1 .run.r1, .hide-2 .run.r2, .hide-3 .run.r3,
.hide-4 .run.r4, .hide-5 .run.r5, .hide-6 .run.r6, .hide-7 .run.r7 { display: none }

* { box-sizing: border-box }
body {
  margin: 0; background: var(--ground); color: var(--ink);
  font: 15px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif;
  font-variant-numeric: tabular-nums; --right: 14px;
}
body.several { --right: 26px }
main { max-width: 1280px; margin: 0 auto; padding: 32px 24px 48px }
h1, h2, h3, p, figure, dl, dd { margin: 0 }
h1 { font-size: 30px; line-height: 1.2; letter-spacing: -.01em; overflow-wrap: anywhere }
section > h2 { font-size: 20px; margin: 40px 0 4px }
section > p { color: var(--soft); max-width: 75ch; margin-bottom: 14px }
section > h2 + .grid, section > h2 + .table { margin-top: 14px }
h3 { font-size: 15px; font-weight: 650 }
.eyebrow { color: var(--soft); font-size: 12px; letter-spacing: .1em; text-transform: uppercase; margin-bottom: 4px }
.lead { color: var(--soft); margin-top: 6px }
.unit { color: var(--soft); font-weight: 400 }
.badge {
  display: inline-block; min-width: 1.5em; padding: 0 .35em; margin-right: .5em; border-radius: 4px;
  background: var(--c); color: var(--card); font-size: .85em; line-height: 1.5; text-align: center
}

.cards { display: grid; gap: 16px; margin-top: 22px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 300px), 1fr)) }
.card, .chart, .table { background: var(--card); border: 1px solid var(--line); border-radius: 10px; min-width: 0 }
.card { padding: 16px 18px 18px; border-top: 4px solid var(--c) }
.card h2 { font-size: 17px; overflow-wrap: anywhere }
.card p { color: var(--soft); font-size: 13px; margin: 4px 0 14px; overflow-wrap: anywhere }
.card dl { display: grid; gap: 14px 18px; grid-template-columns: repeat(auto-fill, minmax(128px, 1fr)) }
.card dl div { display: flex; flex-direction: column-reverse; justify-content: flex-end }
.card dt { color: var(--soft); font-size: 12.5px; line-height: 1.3 }
.card dd { font-size: 24px; font-weight: 650; letter-spacing: -.01em; line-height: 1.25; white-space: nowrap }
.one .card dd { font-size: 28px }
dd small { font-size: 13px; font-weight: 400; color: var(--soft); margin-left: .5em; letter-spacing: 0 }

.keys { position: sticky; top: 0; z-index: 5; display: flex; flex-wrap: wrap; gap: 4px 18px; margin: 22px -24px 0; padding: 9px 24px;
        background: var(--ground); border-bottom: 1px solid var(--line); font-size: 14px }
.key { overflow-wrap: anywhere }
.keys .key[role] { cursor: pointer; user-select: none }
.keys .key[aria-pressed=false] { opacity: .45; text-decoration: line-through }

.grid { display: grid; gap: 16px; grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)) }
.wide { grid-column: 1 / -1 }
.chart { padding: 14px 16px 12px }
.chart figcaption { display: grid; grid-template-columns: auto 1fr; gap: 0 14px; align-items: baseline }
.chart figcaption p { grid-column: 1 / -1; color: var(--soft); font-size: 13px }
.readout { text-align: right; font-size: 13px; min-height: 1.45em; white-space: nowrap; overflow: hidden }
.readout b { color: var(--c); margin-left: .9em; font-weight: 650 }
.over { color: var(--soft) }

.plot { padding: 12px var(--right) 22px 46px; outline-offset: 4px }
.area { position: relative; height: var(--h); cursor: crosshair; touch-action: pan-y }
.area svg { position: absolute; inset: 0; width: 100%; height: 100% }
.area path { fill: none; vector-effect: non-scaling-stroke; stroke-linejoin: round }
.grid { stroke: var(--faint) }
path.grid { stroke: var(--line); stroke-width: 1 }
path.faint { stroke: var(--faint) }
path.line { stroke: var(--c); stroke-width: 1.6 }
.area path.band { fill: var(--c); fill-opacity: .24; stroke: var(--c); stroke-opacity: .4; stroke-width: .8 }
.area path.bars { fill: var(--c); fill-opacity: .75 }
.several .area path.bars { fill-opacity: .12; stroke: var(--c); stroke-width: 1.6 }
path.level { stroke: var(--soft); stroke-width: 1 }
path.percentile { stroke: var(--ink); stroke-opacity: .75 }
path.p95 { stroke-dasharray: 7 4 }
path.p99 { stroke-dasharray: 2 3 }
path.capacity { stroke: var(--c, var(--ink)); stroke-width: 1.5; stroke-dasharray: 8 4 }
path.budget { stroke: var(--soft); stroke-dasharray: 1 4 }
.area span, .area b, .area > i { position: absolute; font-size: 11.5px; line-height: 14px; white-space: nowrap; pointer-events: none }
.ty { right: calc(100% + 7px); transform: translateY(50%); color: var(--soft) }
.tx { top: calc(100% + 5px); transform: translateX(-50%); color: var(--soft) }
.level-label { left: calc(100% + 5px); transform: translateY(50%); color: var(--soft) }
.area .level-label.budget { left: auto; right: 4px; transform: none; padding-bottom: 1px }
.one .frames, .one .histogram { --right: 34px }
.area .end { left: calc(100% + 6px); transform: translateY(50%); color: var(--c) }
.area .above { top: -9px; margin-left: -5px; border: 5px solid transparent; border-top: 0; border-bottom: 8px solid var(--c) }
.several .frames { --right: calc(20px + var(--runs) * 13px) }
.area .spread { left: calc(100% + 9px + var(--n) * 13px); width: 5px; min-height: 3px; background: var(--c); border-radius: 2px }
.spread i { position: absolute; left: -2px; right: -2px; height: 2px; background: var(--c); box-shadow: 0 0 0 1px var(--card) }
.area .spread b { bottom: 100%; left: -2px; color: var(--c) }
.area .mark { top: -4px; bottom: 0; border-left: 1.5px solid var(--ink); opacity: .8; padding-left: 3px }
.several .area .mark { border-left-color: var(--c); opacity: 1 }
.area .mark.p95 { border-left-style: dashed; padding-top: 13px }
.area .mark.p99 { border-left-style: dotted; padding-top: 26px }
.area .cross { top: 0; bottom: 0; width: 1px; background: var(--ink); opacity: .55 }
.area .dot { width: 7px; height: 7px; margin: 0 0 -3.5px -3.5px; border-radius: 50%; background: var(--c); box-shadow: 0 0 0 1.5px var(--card) }
.tip { position: fixed; z-index: 9; pointer-events: none; background: var(--card); border: 1px solid var(--line); border-radius: 6px;
       padding: 6px 10px; font-size: 13px; box-shadow: 0 4px 16px rgb(0 0 0 / .18); max-width: 90vw }
.tip td, .tip th { padding: 1px 0 1px 12px; text-align: right; font-weight: 400; white-space: nowrap }
.tip th { padding-left: 0; color: var(--c); font-weight: 650; text-align: left }
.tip small { color: var(--soft) }
.quiet { color: var(--soft); font-size: 14px; margin-top: 12px }

.strip { position: relative; padding: 10px var(--right) 0 46px; margin-bottom: -12px }
.strip + .strip { padding-top: 14px }
.strip > .badge { position: absolute; left: 8px; top: 14px; margin: 0 }
.shots { position: relative; container-type: inline-size; height: 0; padding-bottom: calc(var(--room) / (var(--shape))); margin-bottom: 18px }
.shots figure { position: absolute; top: 0 }
.shots img { display: block; width: 100%; height: auto; aspect-ratio: var(--shape); border-radius: 4px; background: var(--faint) }
.shots figcaption { display: block; font-size: 11.5px; line-height: 16px; color: var(--soft); text-align: center }
.shots figure.near img { outline: 2px solid var(--c, var(--ink)); outline-offset: 1px }
.strip svg { display: block; width: 100%; height: 16px }
.strip svg path { fill: none; stroke: var(--soft); stroke-opacity: .6; vector-effect: non-scaling-stroke }

table { border-collapse: collapse; width: 100%; font-size: 14px }
.cards + .table { margin-top: 16px }
.table { overflow-x: auto; padding: 12px 16px; margin-bottom: 16px }
caption { text-align: left; font-weight: 650; font-size: 15px; padding-bottom: 6px }
.table th, .table td { padding: 5px 0 5px 18px; text-align: right; vertical-align: top; white-space: nowrap }
.table thead th { color: var(--soft); font-weight: 500; border-bottom: 1px solid var(--line); white-space: normal; overflow-wrap: anywhere }
.table th[scope=row], .table th[scope=rowgroup] { padding-left: 0; text-align: left; font-weight: 400; white-space: normal }
.table th[scope=rowgroup] { font-weight: 650 }
.table th[scope=rowgroup] + th[scope=row] { padding-left: 18px }
.table tbody + tbody tr:first-child > * { border-top: 1px solid var(--line) }
.table tbody:only-of-type tr + tr > * { border-top: 1px solid var(--faint) }
.table small { color: var(--ink); display: inline-block; min-width: 4em; font-size: 12.5px }
.table small.alike { color: var(--soft) }
.table .words th, .table .words td { text-align: left }
.words td { white-space: normal; overflow-wrap: anywhere }
.words { width: auto }
.words td, .words thead th { min-width: 8.5em }
table.bars th { text-align: left; font-weight: 400; font-size: 13px; color: var(--soft); padding: 5px 12px 5px 0; vertical-align: middle; width: 1%; white-space: nowrap }
table.bars tr:last-child > * { border-top: 1px solid var(--line) }
table.bars td { padding: 4px 0 }
.bar { display: flex; align-items: center; margin: 2px 0; padding-right: 58px }
.bar i { flex: none; height: 13px; min-width: 1px; background: var(--c); border-radius: 0 3px 3px 0 }
.bar span { width: 0; margin-left: 6px; font-size: 12.5px; line-height: 16px; white-space: nowrap }
.same { color: var(--soft); margin: 16px 0 }
footer { color: var(--soft); font-size: 13px; margin-top: 32px; border-top: 1px solid var(--line); padding-top: 12px }
footer p + p { margin-top: 4px }

@media (max-width: 640px) {
  main { padding: 20px 12px 32px }
  h1 { font-size: 24px }
  .keys { margin: 16px -12px 0; padding: 8px 12px }
  .chart { padding: 12px 10px 10px }
  .plot { padding-left: 40px }
  .strip { padding: 8px 0 0; margin-bottom: 8px }
  .strip + .strip { padding-top: 8px }
  .several .strip { padding-left: 30px }
  .strip > .badge { left: 0 }
  .strip svg { display: none }
  .shots { display: grid; grid-template-columns: repeat(4, 1fr); gap: 4px; height: auto; padding: 0; margin: 0 }
  .shots figure { position: static; width: auto !important }
  .tx.odd { visibility: hidden }
  .one .card dd { font-size: 24px }
}
@media print {
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact }
  body { background: none; font-size: 12px }
  main { padding: 0 1px; max-width: none }
  .cards { grid-template-columns: repeat(auto-fit, minmax(210px, 1fr)); gap: 10px }
  .card, .one .card { padding: 10px 12px }
  .card dl { grid-template-columns: repeat(auto-fill, minmax(88px, 1fr)); gap: 8px 10px }
  .card dd, .one .card dd { font-size: 16px }
  dd small { font-size: 11px }
  .grid { grid-template-columns: 1fr 1fr; gap: 10px }
  .cards + .table { break-inside: avoid }
  section > h2 { margin-top: 24px }
  .tx.odd { visibility: hidden }
  table { font-size: 11px }
  .table th, .table td { padding: 3px 0 3px 10px }
  .card, .chart, .table tr { break-inside: avoid }
  section > h2, section > p { break-after: avoid }
  .keys { position: static; background: none }
  .readout { display: none }
}
)css";

}  // namespace ridgeline::app::report
