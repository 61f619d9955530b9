// SPDX-License-Identifier: MIT
// The little HTML that the report needs: escaped text, tables, figures, and the page around them.
#pragma once

#include <string>
#include <vector>

namespace atlas::report {

/// Text with & < > " ' replaced, safe inside elements and attributes.
std::string escaped(const std::string& text);

/// A table; cells are plain text. Columns from `first_number_column` on are aligned to the right.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::size_t first_number_column = 1;
};
std::string toHtml(const Table& table);

/// A picture of OUT/report with a caption; `file` is relative to the page.
std::string figure(const std::string& file, const std::string& caption);
/// Anything (an SVG) with a caption.
std::string figureOf(const std::string& content, const std::string& caption);
std::string section(const std::string& title, const std::string& content);
/// Content that opens on a click.
std::string details(const std::string& summary, const std::string& content);

/// One big number with its meaning.
struct KeyFigure {
  std::string value, meaning;
};
std::string toHtml(const std::vector<KeyFigure>& figures);

/// The whole document, styles inside, nothing loaded from anywhere.
std::string document(const std::string& title, const std::string& subtitle, const std::string& body);

}  // namespace atlas::report
