"""The study's report: figures, words and tables made from the results alone, and the page that holds them.

`pictures.pictures` draws, `answer.answer` writes the answer, the `*_tables` modules say the numbers, `page.report_page`
puts all of it into one HTML file. Nothing here computes a model.
"""
