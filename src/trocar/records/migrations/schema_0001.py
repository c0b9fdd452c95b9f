"""Trainees, their attempts with metrics, and recordings."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None


def upgrade() -> None:
    """Make the first tables."""
    op.create_table(
        "trainee",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("name", sa.String, nullable=False, unique=True),
        sa.Column("began", sa.String, nullable=False),
    )
    op.create_table(
        "attempt",
        sa.Column("id", sa.Integer, primary_key=True),
        sa.Column("trainee_id", sa.Integer, sa.ForeignKey("trainee.id"), nullable=False),
        sa.Column("task", sa.String, nullable=False),
        sa.Column("level", sa.Integer, nullable=False),
        sa.Column("device", sa.String, nullable=False),
        sa.Column("status", sa.String, nullable=False),
        sa.Column("reason", sa.String),
        sa.Column("began", sa.String, nullable=False),
        sa.Column("owner", sa.String, nullable=False),
        sa.Column("ticks", sa.Integer, nullable=False),
        sa.Column("dt_s", sa.Float, nullable=False),
        sa.Column("score", sa.Float),
        sa.Column("passed", sa.Boolean),
        sa.Column("completed", sa.Boolean),
        sa.Column("duration_s", sa.Float),
        sa.Column("header", sa.String, nullable=False),
        sa.Column("card", sa.String),
        sa.CheckConstraint("status IN ('running', 'finished', 'interrupted')", name="attempt_status"),
        sqlite_autoincrement=True,
    )
    op.create_index("attempt_of_trainee", "attempt", ["trainee_id", "task", "level"])
    op.create_index("attempt_by_status", "attempt", ["status"])
    op.create_table(
        "metric",
        sa.Column("attempt_id", sa.Integer, sa.ForeignKey("attempt.id"), primary_key=True),
        sa.Column("name", sa.String, primary_key=True),
        sa.Column("value", sa.Float, nullable=False),
        sa.Column("unit", sa.String, nullable=False),
    )
    op.create_table(
        "chunk",
        sa.Column("attempt_id", sa.Integer, sa.ForeignKey("attempt.id"), primary_key=True),
        sa.Column("number", sa.Integer, primary_key=True),
        sa.Column("ticks", sa.Integer, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
    )
