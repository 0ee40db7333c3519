#include "results/document/document.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/document/words.hpp"
#include "results/plot/plot_text.hpp"

namespace mpm {

std::string strong(std::string_view words) {
  return fmt::format("{}{}{}", kStrong, words, kStrongEnd);
}

std::string code(std::string_view text) {
  return fmt::format("{}{}{}", kCode, as_label(text), kCodeEnd);
}

std::string link(std::string_view target, std::string_view words) {
  return fmt::format("{}{}{}{}{}", kLink, target, kLinkTarget, words, kLinkEnd);
}

std::string in_a_row(const std::vector<std::string>& words) {
  if (words.size() < 2)
    return words.empty() ? "" : words.front();
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

std::string listed(const std::vector<std::string>& names, std::string_view none) {
  std::string words;
  for (const std::string& name : names)
    words += (words.empty() ? "" : ", ") + as_label(name);
  return words.empty() ? std::string(none) : words;
}

Number number(const Rate& rate, NumberForm form) {
  return rate.total == 0 ? Number{} : Number{rate.value, form, rate.interval};
}

std::string interval_words(const Interval& interval, int decimals) {
  return std::isnan(interval.lower) || std::isnan(interval.upper)
             ? ""
             : fmt::format(" ({:.{}f} to {:.{}f})", interval.lower, decimals, interval.upper, decimals);
}

std::string share_words(const Rate& rate) {
  if (rate.total == 0)
    return "-";
  return fmt::format("{:.1f} %{}", 100 * rate.value,
                     interval_words({100 * rate.interval.lower, 100 * rate.interval.upper}, 1));
}

Number number_of(const Rate& rate, NumberForm form) {
  return rate.total == 0 ? Number{} : Number{rate.value, form, rate.interval, rate.total};
}

Number number_of(const Estimate& estimate, NumberForm form) {
  return estimate.count == 0 ? Number{} : Number{estimate.value, form, estimate.interval, estimate.count};
}

Cell&& Cell::with(std::string words) && {
  note = std::move(words);
  return std::move(*this);
}

Cell&& Cell::toned(Tone as) && {
  tone = as;
  return std::move(*this);
}

void Section::leave_out(const std::string& why) {
  say("Left out: " + as_label(why), Paragraph::Kind::absent);
}

}  // namespace mpm
