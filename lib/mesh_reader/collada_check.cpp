#include "collada_check.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh_import.hpp"

namespace ayumi::mesh_reader {

namespace {

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

void skip_spaces(std::string_view& text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
}

using Attributes = std::map<std::string, std::string, std::less<>>;

// The attributes of a tag, starting behind its name. The list ends at the first text that is not an
// attribute.
Attributes attributes_of(std::string_view tag) {
  Attributes found;
  while (true) {
    skip_spaces(tag);
    const size_t equal = tag.find('=');
    if (equal == std::string_view::npos) return found;
    std::string name(tag.substr(0, equal));
    while (!name.empty() && is_space(name.back())) name.pop_back();
    tag.remove_prefix(equal + 1);
    skip_spaces(tag);
    if (tag.empty() || (tag.front() != '"' && tag.front() != '\'')) return found;
    const size_t close = tag.find(tag.front(), 1);
    if (close == std::string_view::npos) return found;
    found.emplace(std::move(name), tag.substr(1, close - 1));
    tag.remove_prefix(close + 1);
  }
}

class ColladaCheck {
 public:
  explicit ColladaCheck(const std::string& bytes) : text_(bytes), most_(bytes.size()) {}

  void run() {
    for (size_t at = text_.find('<'); at != std::string_view::npos; at = text_.find('<', at)) {
      if (text_.substr(at).starts_with("<!--")) {
        at = std::min(text_.find("-->", at + 4), text_.size());
        continue;
      }
      const size_t end = end_of_tag(at);
      visit(text_.substr(at + 1, end - at - 1), end);
      at = end;
    }
    for (const Accessor& accessor : accessors_) check(accessor);
  }

 private:
  struct Accessor {
    std::string source;
    size_t count = 0, stride = 1, offset = 0;
    size_t parameters = 0;
  };

  // A '>' between quotes does not end a tag.
  size_t end_of_tag(size_t at) const {
    char quote = 0;
    for (; at < text_.size(); ++at) {
      const char c = text_[at];
      if (quote == 0 && c == '>') break;
      if (quote == 0 && (c == '"' || c == '\''))
        quote = c;
      else if (c == quote)
        quote = 0;
    }
    return at;
  }

  void visit(std::string_view tag, size_t end) {
    const size_t name_end = std::min(tag.find_first_of(" \t\r\n/"), tag.size());
    std::string_view name = tag.substr(0, name_end);
    if (const size_t colon = name.find(':'); colon != std::string_view::npos)
      name.remove_prefix(colon + 1);
    if (name == "p" || name == "v" || name == "vcount") {
      check_list(end + 1);
      return;
    }
    if (name == "param" && !accessors_.empty()) ++accessors_.back().parameters;
    const Attributes attributes = attributes_of(tag.substr(name_end));
    const auto count = attributes.find("count");
    if (count == attributes.end()) return;
    if (name == "accessor") {
      const auto source = attributes.find("source");
      accessors_.push_back({source == attributes.end() ? "" : source->second, number(count->second),
                            number_of(attributes, "stride").value_or(1),
                            number_of(attributes, "offset").value_or(0), 0});
    } else if (name.ends_with("_array")) {
      const auto id = attributes.find("id");
      const size_t size = number(count->second);
      // If two arrays have the same name, the smaller one counts.
      const auto [known, fresh] =
          sizes_.emplace("#" + (id == attributes.end() ? "" : id->second), size);
      if (!fresh) known->second = std::min(known->second, size);
    } else {
      number(count->second);
    }
  }

  void check_list(size_t begin) const {
    std::string_view items = text_.substr(std::min(begin, text_.size()));
    items = items.substr(0, items.find('<'));
    for (skip_spaces(items); !items.empty(); skip_spaces(items)) {
      const auto stop = std::find_if(items.begin(), items.end(), is_space);
      const size_t length = static_cast<size_t>(stop - items.begin());
      number(items.substr(0, length));
      items.remove_prefix(length);
    }
  }

  std::optional<size_t> number_of(const Attributes& attributes, const char* name) const {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return {};
    return number(found->second);
  }

  // In a sound file, no count and no index exceeds the number of bytes.
  size_t number(std::string_view word) const {
    size_t value = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || last != word.data() + word.size() || value > most_)
      throw Refusal("'" + std::string(word.substr(0, 40)) +
                    "' is not a valid count or index; export the mesh again");
    return value;
  }

  // All factors are at most the number of bytes, so that the product fits.
  void check(const Accessor& accessor) const {
    const auto size = sizes_.find(accessor.source);
    // Assimp complains of a missing array itself.
    if (size == sizes_.end() || accessor.count == 0) return;
    const size_t reached =
        accessor.offset + (accessor.count - 1) * accessor.stride + accessor.parameters;
    if (reached > size->second)
      throw Refusal("an accessor reaches number " + std::to_string(reached) + " of '" +
                    accessor.source.substr(0, 40) + "', which has " + std::to_string(size->second) +
                    "; export the mesh again");
  }

  std::string_view text_;
  size_t most_;
  std::vector<Accessor> accessors_;
  std::map<std::string, size_t, std::less<>> sizes_;
};

}  // namespace

void check_collada(const std::string& bytes) { ColladaCheck(bytes).run(); }

}  // namespace ayumi::mesh_reader
