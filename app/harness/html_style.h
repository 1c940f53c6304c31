#pragma once

namespace trimtab::harness {

/// The style sheet. Colours are variables, so that dark screens and paper have their own. It must contain no
/// `<` and no `&`, because the page is XML.
inline constexpr const char* kStyle = R"css(
:root{--ground:#fff;--ink:#1b1f24;--quiet:#5c6470;--line:#d5d9de;--band:#f4f6f8;--good:#00714f;--bad:#fff;
--badground:#b3261e;--slow:#a84300;--link:#0058a8}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1280px;padding:1.2rem 1.2rem 4rem;background:var(--ground);color:var(--ink);
font:15px/1.45 system-ui,sans-serif}
h1{font-size:1.6rem;margin:.2rem 0 .4rem;overflow-wrap:anywhere}
h2{font-size:1.25rem;margin:2.4rem 0 .5rem;border-bottom:2px solid var(--line);padding-bottom:.2rem}
h3{font-size:1.05rem;margin:1.5rem 0 .3rem;overflow-wrap:anywhere}
h4{font-size:.95rem;margin:1.1rem 0 .1rem}
p{max-width:85ch;margin:.4rem 0;overflow-wrap:anywhere}
small{color:var(--quiet);font-weight:400}
a{color:var(--link)}
nav{display:flex;flex-wrap:wrap;gap:.2rem 1.1rem;margin:.8rem 0}
.none,.units{color:var(--quiet)}
.alarm{background:var(--badground);color:var(--bad);padding:.5rem .8rem;border-radius:4px;font-weight:600}
.fine{border-left:4px solid var(--good);padding:.2rem .8rem}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:.15rem 1rem;margin:.6rem 0}
.facts dt{color:var(--quiet)}
.facts dd{margin:0;overflow-wrap:anywhere}
.scroll{overflow-x:auto;margin:.8rem 0}
table{border-collapse:collapse;font-size:.86rem;font-variant-numeric:tabular-nums;min-width:100%}
caption{text-align:left;color:var(--quiet);padding:.2rem 0;caption-side:top}
th,td{padding:.3rem .55rem;text-align:left;vertical-align:top;border-bottom:1px solid var(--line)}
th{background:var(--band);vertical-align:bottom;line-height:1.2}
td:first-child,td:nth-child(2){max-width:18rem;overflow-wrap:anywhere}
.n{text-align:right}
td small,th small{display:block;font-size:.82em;white-space:nowrap}
td.n,td.t{white-space:nowrap}
.good{color:var(--good)}
.slow{color:var(--slow)}
.bad{background:var(--badground);color:var(--bad);font-weight:700}
.bad small{color:var(--bad)}
th.sortable{cursor:pointer}
th[aria-sort=ascending]::after{content:" \25B2"}
th[aria-sort=descending]::after{content:" \25BC"}
figure{margin:.3rem 0;min-width:0}
figcaption{color:var(--quiet);font-size:.86rem}
svg.plot{display:block;width:100%;max-width:1020px;height:auto;max-height:90vh}
svg.key{vertical-align:-3px}
.legend{list-style:none;display:flex;flex-wrap:wrap;gap:.1rem 1.1rem;padding:0;margin:.5rem 0;font-size:.9rem}
.legend li{overflow-wrap:anywhere}
.central{display:grid;grid-template-columns:minmax(0,19fr) minmax(0,11fr);gap:0 .6rem;align-items:start}
.central figure:first-child{grid-row:1/span 2}
.small{display:grid;grid-template-columns:repeat(auto-fill,minmax(320px,1fr));gap:.2rem .8rem}
.three{display:grid;grid-template-columns:repeat(auto-fit,minmax(260px,1fr));gap:.5rem}
.three figure{max-width:640px}
img{display:block;width:100%;height:auto;background:var(--band)}
.absent{border:1px dashed var(--quiet);padding:1.2rem;color:var(--quiet);margin:0}
.numbers{display:flex;flex-wrap:wrap;gap:.1rem 1.3rem;margin:.3rem 0;font-size:.86rem}
.numbers dt,.numbers dd{display:inline;margin:0}
.numbers dt{color:var(--quiet);margin-right:.35rem}
article{border-bottom:1px solid var(--line);padding-bottom:.6rem}
footer{margin-top:2.5rem;color:var(--quiet);font-size:.86rem}
@media (max-width:820px){.central{grid-template-columns:minmax(0,1fr)}
.central figure+figure{max-width:520px}
.facts{grid-template-columns:1fr;gap:0}.facts dd{margin:0 0 .3rem}}
@media screen and (prefers-color-scheme:dark){
:root{color-scheme:dark;--ground:#14171b;--ink:#e6e9ed;--quiet:#a2abb6;--line:#353c45;--band:#1f242b;--good:#4fd1a5;
--bad:#fff;--badground:#a3241d;--slow:#f5a15f;--link:#7fbdf5}
svg text{fill:#e6e9ed}
svg .halo{stroke:#14171b}
svg .grid{stroke:#353c45}
svg .axis{stroke:#a2abb6}
svg .quiet{stroke:#8b95a1}
svg .mark{stroke:#14171b}
svg path.ink{fill:#e6e9ed}
svg .f0{fill:#4a9be0}svg .f1{fill:#f07f32}svg .f2{fill:#22bd90}svg .f3{fill:#e09cc2}svg .f4{fill:#f2b634}
svg .f5{fill:#9ad6fa}
svg .k0{stroke:#4a9be0}svg .k1{stroke:#f07f32}svg .k2{stroke:#22bd90}svg .k3{stroke:#e09cc2}svg .k4{stroke:#f2b634}
svg .k5{stroke:#9ad6fa}}
@media print{.central{grid-template-columns:minmax(0,19fr) minmax(0,11fr)}
.central figure+figure{max-width:none}.facts{grid-template-columns:max-content 1fr;gap:.15rem 1rem}
body{max-width:none;padding:0;font-size:9.5pt}nav,.sortable::after{display:none}
table{font-size:6.8pt}th,td{padding:.1rem .25rem}.scroll{overflow:visible}thead{display:table-header-group}
tr,figure,article{break-inside:avoid}h2,h3,h4{break-after:avoid}
.bad,.alarm{-webkit-print-color-adjust:exact;print-color-adjust:exact;outline:2px solid #000}
.small{grid-template-columns:repeat(3,1fr)}}
)css";

/// Sorts a table by the column whose head is pressed; the page is whole without it.
inline constexpr const char* kScript = R"js(
document.querySelectorAll('table').forEach(function(table){
  var heads=table.tHead.rows[0].cells;
  Array.prototype.forEach.call(heads,function(head,column){
    function sort(){
      var down=head.getAttribute('aria-sort')==='ascending';
      Array.prototype.forEach.call(heads,function(h){h.removeAttribute('aria-sort');});
      head.setAttribute('aria-sort',down?'descending':'ascending');
      function key(row){var v=row.cells[column].getAttribute('data-v');
        return v===null?row.cells[column].textContent:v==='inf'?Infinity:v==='-inf'?-Infinity:Number(v);}
      Array.from(table.tBodies[0].rows).sort(function(a,b){
        var x=key(a),y=key(b);
        if(x===''||y==='')return (x==='')-(y==='');
        var order=typeof x==='number'?(x===y?0:x-y):String(x).localeCompare(String(y));
        return down?-order:order;
      }).forEach(function(row){table.tBodies[0].appendChild(row);});
    }
    head.className+=' sortable';head.tabIndex=0;head.onclick=sort;
    head.onkeydown=function(e){if(e.key==='Enter'||e.key===' '){e.preventDefault();sort();}};
  });
});
)js";

}  // namespace trimtab::harness
