"""Pictures of an attempt and of practice, as SVG text for the trainer's dark page; one concept a file.

They are drawn without pyplot from the study's settings (`study.report.figures.style`), know no database, and are the
same letter for letter when drawn again. `page` holds what all share.
"""
