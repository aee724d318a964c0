# cmake -DOUT=file.cpp -DPAGE=folder -DBUNDLES=replay.js;author.js -P embed_page.cmake writes the
# texts of the report's page and of the page for authoring as C++ strings. Without BUNDLES, the
# report has no script and there is no page for authoring.
file(READ ${PAGE}/page.css style)
set(replay "")
set(author "")
if(BUNDLES)
  list(GET BUNDLES 0 replay_bundle)
  list(GET BUNDLES 1 author_bundle)
  file(READ ${replay_bundle} replay)
  file(READ ${author_bundle} author_script)
  file(READ ${PAGE}/author.css author_style)
  file(READ ${PAGE}/author.html author)
  string(REPLACE "{{style}}" "${author_style}" author "${author}")
  string(REPLACE "{{script}}" "${author_script}" author "${author}")
endif()
file(WRITE ${OUT} "#include \"ayumi/report/page.hpp\"\n\nnamespace ayumi {\n\n"
  "const std::string_view kPageStyle = R\"page_text(${style})page_text\";\n"
  "const std::string_view kReplayScript = R\"page_text(${replay})page_text\";\n"
  "const std::string_view kAuthorPage = R\"page_text(${author})page_text\";\n"
  "\n}  // namespace ayumi\n")
