// SPDX-License-Identifier: MIT
#include "report/html.hpp"

namespace atlas::report {
namespace {

const char* const kStyle = R"(
:root { --ink: #1d2430; --soft: #5b6675; --line: #dfe4ea; --paper: #fff; --ground: #f4f6f8; --accent: #1667b7; --bad: #b3261e }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6eaf0; --soft: #9aa6b5; --line: #333c48; --paper: #1b212a; --ground: #12161c; --accent: #6db3f7; --bad: #ff8a80 } }
* { box-sizing: border-box }
body { margin: 0; background: var(--ground); color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif }
main { max-width: 1180px; margin: 0 auto; padding: 28px 20px 60px }
h1 { font-size: 26px; margin: 0 } h2 { font-size: 18px; margin: 0 0 12px }
.subtitle { color: var(--soft); margin: 2px 0 20px; overflow-wrap: anywhere }
section { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: 18px 20px; margin: 0 0 18px }
.keys { display: grid; grid-template-columns: repeat(auto-fit, minmax(130px, 1fr)); gap: 12px; margin: 0 0 18px }
.key { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: 12px 14px }
.key b { display: block; font-size: 22px; font-weight: 600; color: var(--accent) } .key span { color: var(--soft); font-size: 13px }
.grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(420px, 1fr)); gap: 18px }
@media (max-width: 520px) { .grid { grid-template-columns: 1fr } }
figure { margin: 0 } figure img, figure svg { width: 100%; height: auto; border-radius: 6px; display: block }
figcaption { color: var(--soft); font-size: 13px; margin-top: 6px }
.scroll { overflow-x: auto }
table { border-collapse: collapse; width: 100%; font-size: 14px } th { color: var(--soft); font-weight: 500; text-align: left }
th, td { padding: 4px 12px 4px 0; border-bottom: 1px solid var(--line); vertical-align: top }
.n { text-align: right; font-variant-numeric: tabular-nums; padding-right: 18px }
details { margin-top: 12px } summary { cursor: pointer; color: var(--accent) }
.problem { color: var(--bad) } ul { margin: 0; padding-left: 20px }
)";

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string toHtml(const Table& table) {
  const auto cell = [&table](const char* tag, std::size_t column, const std::string& text) {
    const std::string kind = column >= table.first_number_column ? " class=\"n\"" : "";
    return "<" + std::string(tag) + kind + ">" + escaped(text) + "</" + tag + ">";
  };
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t i = 0; i < table.header.size(); ++i) html += cell("th", i, table.header[i]);
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += cell("td", i, row[i]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string figure(const std::string& file, const std::string& caption) {
  const std::string link = escaped(file);
  return figureOf("<a href=\"" + link + "\"><img src=\"" + link + "\" alt=\"" + escaped(caption) + "\"></a>",
                  caption);
}

std::string figureOf(const std::string& content, const std::string& caption) {
  return "<figure>" + content + "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

std::string section(const std::string& title, const std::string& content) {
  return "<section><h2>" + escaped(title) + "</h2>\n" + content + "</section>\n";
}

std::string details(const std::string& summary, const std::string& content) {
  return "<details><summary>" + escaped(summary) + "</summary>\n" + content + "</details>\n";
}

std::string toHtml(const std::vector<KeyFigure>& figures) {
  std::string html = "<div class=\"keys\">";
  for (const KeyFigure& key : figures) {
    html +=
        "<div class=\"key\"><b>" + escaped(key.value) + "</b><span>" + escaped(key.meaning) + "</span></div>";
  }
  return html + "</div>\n";
}

std::string document(const std::string& title, const std::string& subtitle, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n<style>" + kStyle + "</style></head>\n<body><main>\n<h1>" +
         escaped(title) + "</h1>\n<p class=\"subtitle\">" + escaped(subtitle) + "</p>\n" + body +
         "</main></body></html>\n";
}

}  // namespace atlas::report
