#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/methods/assessment_method.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The methods that a study may name: those of this program, and methods that were added, such as programs.
class MethodTable {
 public:
  /// The methods of this program, the chain of the thesis first.
  MethodTable();

  /// Adds a method, as the last one, and its variants. Throws InputError if the name exists already.
  void add(AssessmentMethodInfo method);

  const std::vector<AssessmentMethodInfo>& methods() const { return methods_; }
  /// The methods that a study gets only by name: with_other_information() and reduced_methods() of each
  /// method, and composites of two methods.
  const std::vector<AssessmentMethodInfo>& variants() const { return variants_; }
  std::vector<std::string> names() const;
  /// names() and the names of the variants.
  std::vector<std::string> every_name() const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  /// The method of this name. Throws InputError, with the known names, if there is none.
  const AssessmentMethodInfo& method(std::string_view name) const;
  /// These names, with "all" replaced by names(), without variants. `key` is for messages. Throws InputError
  /// for an unknown method, a method that is named twice, or an empty list.
  std::vector<std::string> known(const std::vector<std::string>& names, const std::string& key) const;
  /// The tables [assessment.NAME] of all methods that have options, in their order.
  std::vector<MethodOptionTable> option_tables() const;

 private:
  const AssessmentMethodInfo* find(std::string_view name) const;
  void add_variants(const AssessmentMethodInfo& method);

  std::vector<AssessmentMethodInfo> methods_, variants_;
};

/// The methods of this program.
const MethodTable& shipped_methods();
/// shipped_methods().method(name).
const AssessmentMethodInfo& assessment_method(std::string_view name);

/// The methods that a study with these options may name.
const MethodTable& method_table(const AssessmentOptions& options);

/// The names of the methods of a study. Errors: as MethodTable::known().
std::vector<std::string> study_methods(const Study& study);

}  // namespace mpm
