#include "analysis/methods/method_table.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/composite_method.hpp"
#include "base/error.hpp"
#include "scenarios/study/assessment_options.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "scenarios/toml/toml_table.hpp"

namespace mpm {

// The one list of all methods, in the order in which people read them. NAME stands for the function
// NAME_method() of the source NAME_method.cpp in a folder beside this file.
// clang-format off
#define MPM_EACH_METHOD(method)                                                \
  method(botelho)   /* the chain of the thesis, appendix A2 */                 \
  method(sun)       /* model quality index, appendix A1.1 */                   \
  method(badwe2009) /* partial correlations, appendix A1.2 */                  \
  method(badwe2010) /* designed outputs, section 3.1 */                        \
  method(yu_qin)    /* variability against a benchmark, section 2.2.2, A1.3 */ \
  method(variance_ratio) /* var y against that of the benchmark: the baseline */ \
  method(sse)       /* simulation errors against a benchmark (4.17), (6.21) */ \
  method(counterfactual) /* the simulated nominal loop, (3.24), (4.14) */      \
  method(mpmbench)  /* impact, CV, source, channel, parameter and size together */ \
  method(order)     /* do the MVs help to predict the simulation errors? */    \
  method(excitation) /* do signals from outside the loop help to predict them? */ \
  method(candidates) /* do logged signals that are not in the model help? */   \
  method(likelihood) /* the posterior of all faults, of any size */            \
  method(adequacy)  /* does the repair of a channel bring more than it is worth? */ \
  method(ceiling)    /* likelihood with the distributions of the study */      \
  method(lasso)     /* L1 regression of the simulation errors, Kono 2023 */    \
  method(local)     /* local approach to model divergence, Jiang 2009 */       \
  method(mqi_channels) /* model quality without each submodel, Li 2017 */      \
  method(arx_oe)    /* plant and noise models against a benchmark, Lu 2020 */  \
  method(pmr)       /* plant-model ratio, Selvanathan and Tangirala 2010 */        \
  method(autocovariance) /* autocovariances of a linear loop, Wang 2018 */
// clang-format on

#define MPM_DECLARE(name) AssessmentMethodInfo name##_method();
MPM_EACH_METHOD(MPM_DECLARE)
#undef MPM_DECLARE

#define MPM_CALL(name) name##_method(),
MethodTable::MethodTable() : methods_{MPM_EACH_METHOD(MPM_CALL)} {
  for (const AssessmentMethodInfo& method : methods_)
    add_variants(method);
  // Baselines: what a trivial division of labour between two methods reaches.
  for (const auto& [detector, namer] : {std::pair("sse", "lasso"), std::pair("counterfactual", "order")})
    variants_.push_back(
        composite_method(fmt::format("{}+{}", detector, namer), method(detector), method(namer)));
}
#undef MPM_CALL

void MethodTable::add_variants(const AssessmentMethodInfo& method) {
  if (auto other = with_other_information(method))
    variants_.push_back(*std::move(other));
  for (AssessmentMethodInfo& reduced : reduced_methods(method))
    variants_.push_back(std::move(reduced));
}

void MethodTable::add(AssessmentMethodInfo method) {
  if (has(method.name))
    throw InputError("method", fmt::format("'{}' from outside", method.name),
                     fmt::format("a name that is not one of {}", fmt::join(names(), ", ")));
  add_variants(method);
  methods_.push_back(std::move(method));
}

std::vector<std::string> MethodTable::names() const {
  std::vector<std::string> names;
  for (const AssessmentMethodInfo& method : methods_)
    names.push_back(method.name);
  return names;
}

std::vector<std::string> MethodTable::every_name() const {
  std::vector<std::string> names = this->names();
  for (const AssessmentMethodInfo& method : variants_)
    names.push_back(method.name);
  return names;
}

const AssessmentMethodInfo* MethodTable::find(std::string_view name) const {
  for (const auto* const list : {&methods_, &variants_})
    for (const AssessmentMethodInfo& method : *list)
      if (method.name == name)
        return &method;
  return nullptr;
}

const AssessmentMethodInfo& MethodTable::method(std::string_view name) const {
  if (const AssessmentMethodInfo* const found = find(name))
    return *found;
  throw InputError("method", with_nearest(name, every_name()), fmt::format("{}", fmt::join(names(), ", ")));
}

std::vector<std::string> MethodTable::known(const std::vector<std::string>& names,
                                            const std::string& key) const {
  const auto refuse = [&](const std::string& found) {
    throw InputError(key, found, fmt::format("each once: {}; or all", fmt::join(this->names(), ", ")));
  };
  if (names == std::vector<std::string>{"all"})
    return this->names();
  if (names.empty())
    refuse("no method");
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (!has(*name))
      refuse(with_nearest(*name, every_name()));
    if (std::find(names.begin(), name, *name) != name)
      refuse(fmt::format("'{}' twice", *name));
  }
  return names;
}

std::vector<MethodOptionTable> MethodTable::option_tables() const {
  std::vector<MethodOptionTable> tables;
  for (const AssessmentMethodInfo& method : methods_)
    if (method.options) {
      tables.push_back(*method.options);
      tables.back().name = method.name;
    }
  return tables;
}

const MethodTable& shipped_methods() {
  static const MethodTable table;
  return table;
}

const AssessmentMethodInfo& assessment_method(std::string_view name) {
  return shipped_methods().method(name);
}

const MethodTable& method_table(const AssessmentOptions& options) {
  return options.table ? *options.table : shipped_methods();
}

std::vector<std::string> study_methods(const Study& study) {
  return method_table(study.assessment).known(study.methods, "methods.names");
}

}  // namespace mpm
