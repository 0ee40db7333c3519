#include "results/plot/plot_text.hpp"

#include <utility>

#include "results/files/utf8.hpp"

namespace mpm {
namespace {

/// Used for an apostrophe, since gnuplot 5.4 misreads a doubled quote at the beginning of a string.
constexpr std::string_view kApostrophe = "\xE2\x80\x99";
constexpr std::string_view kMarkup = "\\_^{}@&~";  // characters that gnuplot reads as markup, and '\' itself

/// Splits a label and passes on its pieces: on_text(characters), on_sub() at "_{", on_end() at its "}".
template <class OnText, class OnSub, class OnEnd>
void read_label(std::string_view label, OnText on_text, OnSub on_sub, OnEnd on_end) {
  bool subscript = false;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label[i] == '\\' && i + 1 < label.size()) {
      on_text(label.substr(++i, 1));
    } else if (label.substr(i, 2) == "_{") {
      ++i;
      subscript = true;
      on_sub();
    } else if (label[i] == '}' && subscript) {
      subscript = false;
      on_end();
    } else {
      on_text(label.substr(i, 1));
    }
  }
  if (subscript)
    on_end();
}

std::string html_character(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {c};
  }
}

std::string html_raw(std::string_view text) {
  std::string html;
  for (const char c : text)
    html += html_character(c);
  return html;
}

}  // namespace

std::string shown_text(std::string_view text) {
  std::string shown = proper_utf8(text);
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      c = ' ';
  return shown;
}

std::string as_label(std::string_view text) {
  std::string label;
  for (const char c : shown_text(text)) {
    if (kMarkup.find(c) != std::string_view::npos)
      label += '\\';
    label += c;
  }
  return label;
}

std::string gnuplot_label(std::string_view label) {
  std::string quoted = "'";
  read_label(
      shown_text(label),  // a line break would end the command
      [&](std::string_view text) {
        if (kMarkup.find(text[0]) != std::string_view::npos)
          quoted += '\\';
        quoted += text == "'" ? kApostrophe : text;
      },
      [&] { quoted += "_{"; }, [&] { quoted += '}'; });
  return quoted + "'";
}

std::string html_label(std::string_view label) {
  std::string html;
  read_label(
      label, [&](std::string_view text) { html += html_character(text[0]); }, [&] { html += "<sub>"; },
      [&] { html += "</sub>"; });
  return html;
}

std::string plain_label(std::string_view label) {
  std::string plain;
  read_label(
      label, [&](std::string_view text) { plain += text; }, [&] { plain += '_'; }, [] {});
  return plain;
}

std::string html_text(std::string_view text) {
  return html_raw(shown_text(text));
}

}  // namespace mpm
