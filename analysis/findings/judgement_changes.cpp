#include "analysis/findings/judgement_changes.hpp"

#include <utility>

namespace mpm {

void JudgementChanges::add(JudgementPair pair, int cluster) {
  if (pair.before == Correctness::not_judged && pair.now == Correctness::not_judged)
    return;
  ++pairs;
  const bool was = pair.before == Correctness::right, is = pair.now == Correctness::right;
  clusters.add(cluster, was, is);
  if (was != is)
    (was ? lost : gained).push_back(std::move(pair));
}

}  // namespace mpm
