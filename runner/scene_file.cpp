#include "runner/scene_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <CLI/CLI.hpp>
#include <vector>

#include "lcmtypes/nearest_option.h"
#include "scene/mesh_file.h"

namespace nextview {
namespace {

namespace fs = std::filesystem;
constexpr const char* kModel = "model";
constexpr const char* kSceneOption = "SCENE";

class SceneFile {
 public:
  SceneFile(fs::path file, CLI::App& app) : file_(std::move(file)), app_(app) {
    try {
      table_ = toml::parse_file(file_.string());
    } catch (const toml::parse_error& error) {
      fail(error.source(), std::string(error.description()));
    }
  }

  void apply() {
    apply(table_);
    if (!has_model_) {
      throw SceneError(file_.string() + ": lacks model, the name of the CAD file");
    }
  }

 private:
  void apply(const toml::table& table) {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (const toml::table* group = value.as_table()) {
        apply(*group);
      } else if (name == kModel) {
        take_model(value);
      } else {
        take_option(name, value);
      }
    }
  }

  void take_model(const toml::node& value) {
    const auto model = value.value_exact<std::string>();
    if (!model) fail(value.source(), "model must be a file's name");
    has_model_ = true;
    const fs::path beside = file_.parent_path() / *model;  // an absolute name stays as it is
    CLI::Option& scene = *app_.get_option(kSceneOption);
    scene.clear();
    set(scene, {beside.string()}, value);
  }

  void take_option(const std::string& name, const toml::node& value) {
    CLI::Option* option = name == "scenes" ? nullptr : app_.get_option_no_throw("--" + name);
    if (option == nullptr) {
      fail(value.source(), fmt::format("no option '{}'; did you mean '{}'?", name,
                                       nearest_option(app_, name, kModel)));
    }
    if (option->count() == 0) set(*option, texts_of(name, value), value);
  }

  void set(CLI::Option& option, const std::vector<std::string>& texts, const toml::node& value) {
    try {
      if (!texts.empty()) option.add_result(texts);
      option.run_callback();
    } catch (const CLI::Error& error) {
      fail(value.source(), error.what());
    }
  }

  // As they would be typed.
  std::vector<std::string> texts_of(const std::string& name, const toml::node& value) const {
    std::vector<std::string> texts;
    if (const toml::array* list = value.as_array()) {
      for (const toml::node& each : *list) texts.push_back(text_of(name, each));
    } else {
      texts.push_back(text_of(name, value));
    }
    return texts;
  }
  std::string text_of(const std::string& name, const toml::node& value) const {
    if (const auto text = value.value_exact<std::string>()) return *text;
    if (const auto number = value.value_exact<std::int64_t>()) return fmt::format("{}", *number);
    if (const auto number = value.value_exact<double>()) return fmt::format("{}", *number);
    if (const auto flag = value.value_exact<bool>()) return *flag ? "true" : "false";
    fail(value.source(), name + " must be a number, a text, true or false, or a list of them");
  }

  [[noreturn]] void fail(const toml::source_region& where, const std::string& why) const {
    throw SceneError(fmt::format("{}:{}: {}", file_.string(), where.begin.line, why));
  }

  fs::path file_;
  CLI::App& app_;
  toml::table table_;
  bool has_model_ = false;
};

}  // namespace

void apply_scene_file(const fs::path& file, CLI::App& app) { SceneFile(file, app).apply(); }

}  // namespace nextview
