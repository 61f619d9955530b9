// SPDX-License-Identifier: MIT
#include "atlas/output/origins_csv.hpp"

#include <charconv>
#include <string_view>

namespace atlas {
namespace {

/// The text before `separator`, which is taken off with it; all of it without one.
std::string_view take(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

template <class Number>
bool read(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// A number that may be missing; false for what is no number.
bool readOptional(std::string_view text, std::optional<std::uint32_t>& number) {
  return text.empty() || read(text, number.emplace());
}

std::optional<Origin> originOf(std::string_view text, Stamp product) {
  Origin origin;
  origin.topic = take(text, '#');
  std::string_view item = take(text, '@');
  const std::string_view index = take(item, '/');
  Duration offset = 0;
  if (origin.topic.empty() || !readOptional(index, origin.index) || !readOptional(item, origin.item) ||
      !read(text, offset))
    return std::nullopt;
  origin.stamp = product + offset;
  return origin;
}

}  // namespace

std::string originsCsvHeader() { return "product,index,stamp_ns,origins\n"; }

std::string originsCsvRow(const ProductOrigins& product) {
  std::string text =
      product.product + "," + std::to_string(product.index) + "," + std::to_string(product.stamp) + ",";
  const char* between = "";
  for (const Origin& origin : product.origins) {
    text += between + origin.topic + "#" + (origin.index ? std::to_string(*origin.index) : "") +
            (origin.item ? "/" + std::to_string(*origin.item) : "") + "@" +
            std::to_string(origin.stamp - product.stamp);
    between = ";";
  }
  return text + "\n";
}

std::optional<ProductOrigins> parseOriginsRow(const std::string& row) {
  std::string_view rest = row;
  while (!rest.empty() && (rest.back() == '\n' || rest.back() == '\r')) rest.remove_suffix(1);
  ProductOrigins product;
  product.product = take(rest, ',');
  if (product.product.empty() || !read(take(rest, ','), product.index) ||
      !read(take(rest, ','), product.stamp))
    return std::nullopt;
  while (!rest.empty()) {
    const auto origin = originOf(take(rest, ';'), product.stamp);
    if (!origin) return std::nullopt;
    product.origins.push_back(*origin);
  }
  return product;
}

}  // namespace atlas
