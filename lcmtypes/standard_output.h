#pragma once

namespace nextview {

/// Has this program end with status 1, and a line on stderr that begins with its name, in place of
/// status 0, when something that it said on standard output could not be written: a full disk must
/// not look like an answer. A reader who has gone away (`... | head -1`) has what he wanted, and is
/// no error. For the first line of a main; holds however the program ends, short of a signal.
void answer_for_standard_output();

}  // namespace nextview
