"""Trainees, attempts, recordings and answers, kept in one file that outlives the process that writes it.

Everything goes through `Records` (`trocar.records.store`); nothing below this package knows that there is a database.

| file | holds |
|---|---|
| `store` | `Records`: what can be kept and asked for |
| `rows`, `sheets` | what comes out: trainees, attempts, questionnaires that were filled in |
| `changes`, `reading` | what is written into the tables, and what is asked of them |
| `tables`, `migrations`, `schema` | the tables, how they came to be, and how an older file is brought to them |
| `database`, `trouble` | the file opened, and what is said when it cannot be |
| `owner` | which process writes an attempt, and whether it is still there |
| `learning` | a trainee's way through a task: CUSUM, proficiency, what remains |
| `questionnaire`, `opinions` | what is asked about the trainer, and what the answers say |
| `xapi`, `tidy`, `export` | the records for others: statements, a table, files that are whole or not there |
"""
