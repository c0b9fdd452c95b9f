"""Answers to the questionnaire."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Add the answers."""
    op.create_table(
        "answer",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("trainee_id", sa.Integer, sa.ForeignKey("trainee.id"), nullable=False),
        sa.Column("attempt_id", sa.Integer, sa.ForeignKey("attempt.id")),
        sa.Column("group", sa.String, nullable=False),
        sa.Column("item", sa.String, nullable=False),
        sa.Column("value", sa.Integer, nullable=False),
        sa.Column("answered", sa.String, nullable=False),
        sa.CheckConstraint("value BETWEEN 1 AND 5", name="answer_value"),
        sa.UniqueConstraint("trainee_id", "attempt_id", "item", "answered", name="answer_once"),
    )
    op.create_index("answer_of_attempt", "answer", ["attempt_id"])
