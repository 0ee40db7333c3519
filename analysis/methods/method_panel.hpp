#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/assessment_record.hpp"

namespace mpm {

/// The methods of a study, each with what it has learnt about the controller. Each thread has its own panel;
/// an answer depends only on the loop. Values that several methods derive from a loop or from the context are
/// computed once (AssessedLoop::derived, AssessmentContext::derived). The time of an answer includes all
/// values that the method would have derived from the loop if it ran alone.
class MethodPanel {
 public:
  /// The methods assess loops of `study` with what they have learnt in `context`, whose basis case must have
  /// status ok. The study must outlive the panel. Throws InputError for an unknown method.
  MethodPanel(const Study& study, AssessmentContext context, const std::vector<std::string>& methods);
  MethodPanel(const MethodPanel&) = delete;
  MethodPanel& operator=(const MethodPanel&) = delete;

  /// A study that differs from the study of the panel in its controller or its excitation, for one loop. The
  /// methods may know its basis case, whose status must be ok.
  struct Own {
    const Study& study;
    const BasisCase& basis;
  };

  /// The answer of each method on a loop that ran to its end. `y_sim` is that of assessed_loop().
  std::vector<AssessmentRecord> assess(const AssessedLoop& loop, const Own* own = nullptr);

  /// The answer of one method on a loop; none if the method is not in the panel.
  std::optional<AssessmentRecord> assess_by(std::string_view method, const AssessedLoop& loop,
                                            const Own* own = nullptr);

  const AssessmentForms& forms() const { return forms_; }

 private:
  std::vector<AssessmentRecord> assessed(const AssessmentForms& forms, const AssessedLoop& loop,
                                         const Own* own) const;

  const Study& study_;
  AssessmentContext context_;
  AssessmentForms forms_;
};

}  // namespace mpm
