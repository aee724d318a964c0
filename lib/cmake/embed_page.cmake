# cmake -DOUT=file.cpp -DSTYLE=page.css -DSCRIPT=bundle.js -P embed_page.cmake: the texts of the
# report's page as C++ strings; an empty script where SCRIPT is not given.
file(READ ${STYLE} style)
set(script "")
if(SCRIPT)
  file(READ ${SCRIPT} script)
endif()
file(WRITE ${OUT} "#include \"ayumi/report/page.hpp\"\n\nnamespace ayumi {\n\n"
  "const std::string_view kPageStyle = R\"page_text(${style})page_text\";\n"
  "const std::string_view kReplayScript = R\"page_text(${script})page_text\";\n"
  "\n}  // namespace ayumi\n")
