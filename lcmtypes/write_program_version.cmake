# At every build: writes OUTPUT, the source of program_version(), when VERSION or the commit of the
# checkout SOURCE_DIR has changed.
find_package(Git QUIET)
set(text "${VERSION}")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${SOURCE_DIR} describe --always --dirty=+ --abbrev=12
                          --exclude=*
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                  RESULT_VARIABLE failed)
  if(NOT failed)
    string(APPEND text " ${commit}")
  endif()
endif()
set(source "#include \"lcmtypes/program_version.h\"

namespace nextview {
std::string_view program_version() { return \"${text}\"; }
}  // namespace nextview
")
set(present "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} present)
endif()
if(NOT present STREQUAL source)
  file(WRITE ${OUTPUT} "${source}")
endif()
