# Man pages, made of what the programs say of themselves, and completion in bash. Pages are made where
# help2man is installed: ninja man_pages, which packages do by themselves.
foreach(command nextview nextview_run nextview_bound nextview_replay nextview_picture nextview_report nextview_export
                nextview_search nextview_viewer)
  install(FILES nextview.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME ${command} COMPONENT runtime)
endforeach()
find_program(NEXTVIEW_HELP2MAN help2man)
if(NEXTVIEW_HELP2MAN)
  set(pages "")
  foreach(program ${programs})
    get_target_property(name ${program} OUTPUT_NAME)
    set(page ${CMAKE_CURRENT_BINARY_DIR}/${name}.1)
    add_custom_command(OUTPUT ${page}
      COMMAND ${NEXTVIEW_HELP2MAN} --no-info --no-discard-stderr --output ${page} $<TARGET_FILE:${program}>
      DEPENDS ${program} VERBATIM)
    list(APPEND pages ${page})
  endforeach()
  add_custom_target(man_pages DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime OPTIONAL)
endif()
