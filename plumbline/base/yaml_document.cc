// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/yaml_document.h"

#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include <map>
#include <sstream>
#include <vector>

#include <fmt/core.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

namespace plumbline {
namespace {

[[noreturn]] void FailYaml(const std::string& source, int line, const std::string& message) {
  throw InputError(fmt::format("{}:{}: expected {}", source, line, message));
}

// Goes through a document as it is read, before aliases are followed, and knows the keys of the
// groups that are open.
class KeyCheck : public YAML::EventHandler {
 public:
  explicit KeyCheck(const std::string& source) : source_(source) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 2)
      FailYaml(source_, mark.line + 1, "one YAML document, found a second one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { Value(mark, nullptr); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { Value(mark, nullptr); }
  void OnScalar(const YAML::Mark& mark,
                const std::string&,
                YAML::anchor_t,
                const std::string& text) override {
    Value(mark, &text);
  }
  void OnSequenceStart(const YAML::Mark& mark,
                       const std::string&,
                       YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Value(mark, nullptr);
    open_.push_back({false, false, {}});
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark,
                  const std::string&,
                  YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Value(mark, nullptr);
    open_.push_back({true, false, {}});
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Open {
    bool map = false;
    bool value_next = false;          // a key was read
    std::map<std::string, int> keys;  // keys with their lines
  };

  // Takes a node in the innermost list or group, or the document's own. `text` is that of a scalar.
  void Value(const YAML::Mark& mark, const std::string* text) {
    if (open_.empty() || !open_.back().map) return;
    Open& group = open_.back();
    if (!group.value_next && text != nullptr) {
      const auto [place, added] = group.keys.emplace(*text, mark.line + 1);
      if (!added) {
        FailYaml(source_,
                 mark.line + 1,
                 fmt::format("each key once, found {} again, which is in line {}, too",
                             InQuotes(*text),
                             place->second));
      }
    }
    group.value_next = !group.value_next;
  }

  std::string source_;
  int documents_ = 0;
  std::vector<Open> open_;
};

}  // namespace

YAML::Node ParseYaml(const std::string& text, const std::string& source) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    KeyCheck check(source);
    while (parser.HandleNextDocument(check)) {
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    FailYaml(source, error.mark.line + 1, "YAML, found an error: " + error.msg);
  }
}

}  // namespace plumbline
