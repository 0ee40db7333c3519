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
/// an answer depends on the loop only. What several methods derive from a loop or from the context is made
/// once (AssessedLoop::derived, AssessmentContext::derived). The time of an answer includes all values that
/// the method would have derived from the loop if it ran alone.
class MethodPanel {
 public:
  /// Methods that assess loops of `study` by what they have learnt in `context`, whose basis case must have
  /// status ok. The study must outlive the panel. Throws InputError for an unknown method.
  MethodPanel(const Study& study, AssessmentContext context, const std::vector<std::string>& methods);
  MethodPanel(const MethodPanel&) = delete;
  MethodPanel& operator=(const MethodPanel&) = delete;

  /// A loop of another study than that of the panel: under another controller, or another excitation. The
  /// basis case, whose status must be ok, is what the methods may know of it.
  struct Own {
    const Study& study;
    const BasisCase& basis;
  };

  /// The answer of each method on a loop that ran to its end. `y_sim` is that of assessed_loop().
  std::vector<AssessmentRecord> assess(const AssessedLoop& loop, const Own* own = nullptr);

  /// The same by one method: null when it is not one of the panel.
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
