#include "results/report/report_glossary.hpp"

#include <fmt/format.h>

namespace mpm {
namespace {

struct Term {
  const char* anchor;
  const char* word;      ///< HTML
  const char* meaning;   ///< HTML
  bool of_chain = true;  ///< only shown if the chain of the thesis was run
};

constexpr Term kTerms[] = {
    {"cv", "CV, MV, MD", "controlled variable, manipulated variable, measured disturbance", false},
    {"mpm", "MPM", "model-plant mismatch: the plant differs from the model of the controller", false},
    {"ud", "UD", "unmeasured disturbance: something that the controller does not measure moves a CV", false},
    {"y0", "y<sub>0</sub>",
     "nominal output: the CV as it would have been with a perfect model and no disturbance, computed from "
     "the record of the loop"},
    {"s0", "S<sub>0</sub>, T<sub>0</sub>",
     "nominal sensitivity of the closed loop, and its complement: how the loop as designed responds to a "
     "moved limit"},
    {"ivar", "Ivar", "variance of a CV over that of its nominal output: 1 is as designed, larger is worse"},
    {"ivar-diag", "Ivar<sub>diag</sub>",
     "the same for each CV as if it were alone: shows where the error enters"},
    {"ivar-basis", "Ivar<sub>basis</sub>",
     "variance against the same loop without the fault: the truth, which only a "
     "simulation knows"},
    {"impact", "impact", "Ivar outside its band: the fault costs something"},
    {"located", "located",
     "the CV whose Ivar<sub>diag</sub> is farthest from 1, which is taken to be the one with the fault"},
    {"impm", "I<sub>MPM</sub>",
     "how closely the error of the model follows the MVs: above the threshold the source is called a "
     "mismatch, below it a disturbance"},
    {"recognised", "recognised", "the source that is named, MPM or UD, is the true one"},
    {"interval", "interval",
     "range of the true share or number at the stated confidence, given the number of loops", false},
};

}  // namespace

std::string glossary_html(bool chain) {
  std::string items;
  for (const Term& term : kTerms)
    if (chain || !term.of_chain)
      items += fmt::format("<div id=\"term-{}\"><dt>{}</dt><dd>{}</dd></div>\n", term.anchor, term.word,
                           term.meaning);
  return "<aside class=\"glossary\" aria-label=\"Words\">\n<h2>Words</h2>\n<dl>\n" + items +
         "</dl>\n</aside>\n";
}

}  // namespace mpm
