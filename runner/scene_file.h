#pragma once

#include <CLI/App.hpp>
#include <filesystem>

namespace nextview {

/// Sets options from a scene file (TOML), which holds what a run in one scene needs so that
/// `./run my_flat.toml` is enough:
///
///     model = "flat.dae"        # beside this file, or an absolute path; what SCENE would be
///     start = [1.0, 2.5, 1.2]   # or "auto"
///     unit = "cm"
///     range-max = 12.0          # any option of the program, without its dashes
///     quality = true
///
/// An option that the command line gives stays as it is there. Tables ([sensor]) only group keys:
/// what counts is the key.
/// @param app has parsed its command line
/// @throws SceneError naming the file, line and key when it cannot be read, lacks model, or holds a
///         key that no option has (with the one that may have been meant) or a value its option
///         does not take
void apply_scene_file(const std::filesystem::path& file, CLI::App& app);

}  // namespace nextview
