#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"
#include "base/non_finite.hpp"
#include "results/plot/figure.hpp"

// The content of a result, stated once: sections of sentences, tables of typed cells, and figures. The
// writers turn it into text for a terminal (document_text.hpp), a page (document_html.hpp), Markdown
// (document_markdown.hpp) and JSON (document_json.hpp).
//
// Words are labels (results/plot/plot_text.hpp: `_{...}` is a subscript, foreign text goes through
// as_label()) with further marks, which the functions below add. A terminal shows the words without the
// marks.

namespace mpm {

std::string strong(std::string_view words);
/// Marks foreign text that a reader may type: a command, a key, a file.
std::string code(std::string_view text);
/// Links words to `target`, an anchor of the page.
std::string link(std::string_view target, std::string_view words);

/// Joins words: "A", "A and B", "A, B and C"; empty if there are none.
std::string in_a_row(const std::vector<std::string>& words);
/// Lists names as foreign text: "A, B, C", or `none` if there are no names.
std::string listed(const std::vector<std::string>& names, std::string_view none = "");

enum class NumberForm {
  share,          ///< 0.941: "94.1 %"
  percent,        ///< 0.941: "94.1"; the table says that it is a percentage
  whole_percent,  ///< 0.941: "94"
  fixed,          ///< three decimals
  digits,         ///< three digits
};

/// A number with its uncertainty.
struct Number {
  double value = kNaN;  ///< NaN: a dash
  NumberForm form = NumberForm::digits;
  Interval interval{kNaN, kNaN};  ///< NaN: none
  std::int64_t of = -1;           ///< how many loops or experiments it rests on; -1: not shown
};

inline Number fixed(double value, const Interval& interval = {kNaN, kNaN}) {
  return {value, NumberForm::fixed, interval};
}
inline Number share(double value) {
  return {value, NumberForm::share};
}
/// The interval for a sentence, after its number: " (94.5 to 98.5)"; empty if there is no interval.
std::string interval_words(const Interval& interval, int decimals);
/// A rate for a sentence: "97.1 % (94.5 to 98.5)"; a dash if it counts no loops.
std::string share_words(const Rate& rate);
/// A rate as a number; a dash if it counts no loops.
Number number(const Rate& rate, NumberForm form = NumberForm::share);
/// The same with the number of loops or experiments behind it.
Number number_of(const Rate& rate, NumberForm form = NumberForm::share);
Number number_of(const Estimate& estimate, NumberForm form = NumberForm::digits);

/// An entry of a table.
struct Cell {
  enum class Tone { plain, good, bad, strong };

  Cell(std::string words)
      : content(std::move(words)) {}               // NOLINT(google-explicit-constructor): rows are lists
  Cell(const char* words) : content(words) {}      // NOLINT(google-explicit-constructor)
  Cell(const Number& number) : content(number) {}  // NOLINT(google-explicit-constructor)
  /// An integer count.
  template <std::integral Count>
  Cell(Count count) : content(fmt::to_string(count)) {}  // NOLINT(google-explicit-constructor)

  Cell&& with(std::string words) &&;  ///< adds a note
  Cell&& toned(Tone as) &&;

  std::variant<std::string, Number> content;  ///< words or a number; empty words show nothing
  std::string hover = {};                     ///< text that a page shows when the mouse rests on it
  std::string mark = {};                      ///< shown right after the content
  std::string note = {};                      ///< words: small and below on a page; left out of a text
  Tone tone = Tone::plain;
  double ground = kNaN;      ///< depth of the background colour on a page, 0 to 1; NaN: none
  bool low_is_good = false;  ///< uses another background colour
};

/// Where something is shown. `full`: on a page, and in a text for which everything was asked.
enum class Shown { everywhere, page, text, full };

/// Cells in rows under named columns. In a text, columns that do not fit side by side follow below the
/// others.
struct Table {
  enum class Align { left, right, text };  ///< text: left, and wide enough for a sentence
  struct Column {
    std::string title;  ///< words
    Align align = Align::right;
    Shown shown = Shown::everywhere;
  };
  struct Row {
    std::vector<Cell>
        cells;  ///< the first is the heading of its row; fewer than columns leave the last ones empty
    std::string anchor = {};  ///< name by which links find the row; empty: none
    bool is_group = false;    ///< its only cell is a heading across all columns
  };

  Table(std::string of_caption, std::vector<Column> of_columns)
      : caption(std::move(of_caption)), columns(std::move(of_columns)) {}

  void row(std::vector<Cell> cells, std::string anchor = {}) {
    rows.push_back({std::move(cells), std::move(anchor)});
  }
  void group(std::string title) { rows.push_back({{std::move(title)}, {}, true}); }

  std::string caption;  ///< words
  std::vector<Column> columns;
  std::vector<Row> rows = {};
  bool wraps = false;  ///< a page may break cells between words, so that many columns fit
};

/// Words in a paragraph of their own.
struct Paragraph {
  enum class Kind { plain, passed, failed, absent, small };

  std::string words;
  Kind kind = Kind::plain;
};

/// A list of sentences, each after a bullet.
struct Sentences {
  std::vector<std::string> words;
};

/// Names, each with a description.
struct Facts {
  struct Fact {
    std::string name, words;
    std::string note;  ///< words: small and below on a page, after the others in a text
  };

  void add(std::string name, std::string words, std::string note = {}) {
    list.push_back({std::move(name), std::move(words), std::move(note)});
  }

  std::vector<Fact> list = {};
};

/// A piece of a page, which a text leaves out.
struct Html {
  std::string text;
};

/// What the document says about one question, in reading order.
struct Section {
  std::string id;  ///< its anchor
  std::string title;
  std::vector<std::variant<Html, Paragraph, Sentences, Facts, Table, Figure>> content = {};
  std::string answer = {};                ///< words: a sentence below the title
  std::vector<Figure> file_figures = {};  ///< drawn into files only; the page shows a table in their place
  Shown shown = Shown::everywhere;
  /// Adds the data of the section to the JSON object of the document: every number that people see, and those
  /// for which a text has no room. Called when JSON is written; empty: adds nothing.
  std::function<void(nlohmann::ordered_json&)> data = {};

  void add(std::string html) { content.emplace_back(Html{std::move(html)}); }
  void add(const char* html) { add(std::string(html)); }
  template <class Piece>
  void add(Piece piece) {
    content.emplace_back(std::move(piece));
  }
  void say(std::string words, Paragraph::Kind kind = Paragraph::Kind::plain) {
    content.emplace_back(Paragraph{std::move(words), kind});
  }
  /// Adds one sentence that says why content is missing, in place of content without data.
  void leave_out(const std::string& why);
};

/// A result as a whole.
struct Document {
  std::string title = {};    ///< text: title of the window, after "mpmbench: "
  std::string heading = {};  ///< words, as are `lead` and `footer`
  std::string lead = {};     ///< below the heading
  std::string footer = {};   ///< at the end of the page
  std::string version = {};  ///< text: version of the program that made the numbers
  std::vector<Section> sections = {};
  std::string lead_html = {};   ///< content of the page below the lead
  std::string aside_html = {};  ///< beside the body if there is room, else below it
};

}  // namespace mpm
