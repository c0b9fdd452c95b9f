"""The REST interface: tasks, trainees, attempts and their films and pictures, answers. One error shape: `detail`.

Every answer is what a library function returned, as JSON; OpenAPI describes it under /api/openapi.json.
"""

from __future__ import annotations

from http import HTTPStatus
from typing import Annotated, Literal

from fastapi import APIRouter, FastAPI, HTTPException, Path, Query, Request
from fastapi.exception_handlers import http_exception_handler
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from pydantic import BaseModel, ConfigDict, Field
from starlette.exceptions import HTTPException as StarletteHTTPException

from trocar.errors import InputError, TrocarError
from trocar.records.learning import IN_A_ROW
from trocar.records.questionnaire import GROUPS, ITEMS, SCALE
from trocar.records.rows import KeptAttempt
from trocar.training.figures.cusum import cusum
from trocar.training.figures.forces import forces
from trocar.training.figures.learning_curve import learning_curve
from trocar.training.figures.paths import paths
from trocar.training.figures.stages import stages_of
from trocar.training.figures.time_spent import time_spent
from trocar.training.tasks.catalogue import LEVELS, TASKS
from trocar.training.tasks.catalogue import task as task_by_name
from trocar.web.asking import asking
from trocar.web.films import MOST_FRAMES, Films, Screening
from trocar.web.lessons import BusyError, Lessons
from trocar.web.messages import Asked, Hello

_Number = Annotated[int, Path(ge=1, le=2**53)]
_Level = Annotated[int, Path(ge=1, le=9)]
_TOLD = "/api/openapi.json tells what is expected"
_FRAMES, _SVG = "application/octet-stream", "image/svg+xml"
_FIGURES = {"forces": forces, "paths": paths, "time": time_spent}


class Body(BaseModel):
    """What every body shares: nothing is converted, nothing unknown is let through."""

    model_config = ConfigDict(strict=True, extra="forbid")


class NewTrainee(Body):
    """Who trains from now on."""

    name: str = Field(max_length=200)


class NewAttempt(Body):
    """What is to be attempted, and by whom."""

    trainee: str = Field(max_length=200)
    task: str = Field(max_length=80)
    level: int = 1


class NewAnswers(Body):
    """What a trainee thinks of the trainer."""

    trainee: str = Field(max_length=200)
    attempt: int | None = Field(default=None, description="after which; none after a course")
    group: str = Field(max_length=20)
    values: dict[str, int] = Field(max_length=100, description="by item, 1 to 5")


class FilmPart(Asked):
    """What was to be done in a part of a film."""

    end_s: float = Field(description="when it was done, or the film ended")


class FilmSheet(BaseModel):
    """What a film is made of."""

    attempt: int | None
    task: str
    level: int
    frames: int
    every_s: float = Field(
        description="from one frame to the next; the first comes one such time after the start"
    )
    frame_bytes: int = Field(description="length of a frame in the stream's format")
    most_frames: int = Field(description="in one answer")
    steps_s: tuple[float, ...] = Field(description="when each step was done, as many as were")
    mistakes: tuple[dict[str, float | int | str], ...]
    parts: tuple[FilmPart, ...] = Field(description="what was to be done, one part after the other")
    hello: Hello = Field(description="what is shown")


def routes(lessons: Lessons) -> APIRouter:
    """Return the routes of a trainer that has lessons."""
    records, films = lessons.records, Films(lessons.records)
    api = APIRouter(prefix="/api")

    def kept(number: int) -> KeptAttempt:
        try:
            return records.attempt(number)
        except InputError as error:
            raise HTTPException(404, str(error)) from error

    @api.get("/tasks", summary="Every task at every level")
    def tasks() -> list[dict[str, object]]:
        return [task_by_name(name, level).as_dict() for name in TASKS for level in LEVELS]

    @api.get("/tasks/{name}/{level}/film", summary="The scripted expert at a task")
    def expert(name: str, level: _Level) -> FilmSheet:
        return _sheet(films.of_expert(name, level), None)

    @api.get("/tasks/{name}/{level}/film/frames", summary="Frames of it", response_class=Response)
    def expert_frames(name: str, level: _Level, first: int = 0, count: int = 25) -> Response:
        return Response(films.of_expert(name, level).frames(first, count), media_type=_FRAMES)

    @api.get("/trainees", summary="Everyone who trains")
    def trainees() -> list[dict[str, object]]:
        return [{"id": one.id, "name": one.name, "attempts": one.attempts} for one in records.trainees()]

    @api.post("/trainees", summary="Somebody new, or known already", status_code=201)
    def new_trainee(asked: NewTrainee) -> dict[str, object]:
        one = records.trainee(asked.name)
        return {"id": one.id, "name": one.name, "attempts": one.attempts}

    @api.get("/attempts", summary="Attempts, oldest first")
    def attempts(
        trainee: str | None = None, task: str | None = None, level: int | None = None
    ) -> list[dict[str, object]]:
        return [row.as_dict() for row in records.attempts(trainee, task, level)]

    @api.post("/attempts", summary="Begin one; it runs when this answers", status_code=201)
    def begin(asked: NewAttempt) -> dict[str, object]:
        number = lessons.begin(asked.trainee, asked.task, asked.level)
        return records.attempt(number).row.as_dict()

    @api.get("/attempts/{number}", summary="One, with its score card once it is marked")
    def attempt(number: _Number) -> dict[str, object]:
        return kept(number).as_dict()

    @api.post("/attempts/{number}/end", summary="End the one that is under way", status_code=202)
    def end(number: _Number) -> dict[str, object]:
        lessons.end(number)
        return records.attempt(number).row.as_dict()

    @api.get("/attempts/{number}/film", summary="An attempt to be looked at again")
    def film(number: _Number) -> FilmSheet:
        return _sheet(films.of_attempt(kept(number)), number)

    @api.get("/attempts/{number}/film/frames", summary="Frames of it", response_class=Response)
    def frames(number: _Number, first: int = 0, count: int = 25) -> Response:
        return Response(films.of_attempt(kept(number)).frames(first, count), media_type=_FRAMES)

    @api.get("/attempts/{number}/figures/{name}.svg", summary="A picture of it", response_class=Response)
    def figure(number: _Number, name: Literal["forces", "paths", "time"]) -> Response:
        shown = films.of_attempt(kept(number))
        expert = films.of_expert(shown.task.name, shown.task.level)
        drawn = _FIGURES[name](
            shown.film.attempt, shown.film.progress, (expert.film.attempt, expert.film.progress)
        )
        return Response(drawn, media_type=_SVG)

    @api.get("/history/figures/{name}.svg", summary="A picture of it", response_class=Response)
    def chart(
        name: Literal["learning", "cusum"],
        trainee: Annotated[str, Query(max_length=200)],
        task: Annotated[str, Query(max_length=80)],
        level: int = 1,
    ) -> Response:
        practised = task_by_name(task, level)
        history = records.history(trainee, task, level)
        if name == "cusum":
            return Response(cusum([not one for one in history.passed], history.cusum), media_type=_SVG)
        scores = [row.score or 0.0 for row in history.rows]
        drawn = learning_curve(
            scores, history.passed, pass_score=practised.marking.pass_score, in_a_row=IN_A_ROW
        )
        return Response(drawn, media_type=_SVG)

    @api.get("/history", summary="A trainee's way through one task")
    def history(
        trainee: Annotated[str, Query(max_length=200)],
        task: Annotated[str, Query(max_length=80)],
        level: int = 1,
    ) -> dict[str, object]:
        return records.history(trainee, task_by_name(task, level).name, level).as_dict()

    @api.get("/questionnaire", summary="What trainees are asked about the trainer")
    def questionnaire() -> dict[str, object]:
        return {"groups": GROUPS, "items": ITEMS, "scale": SCALE}

    @api.post("/answers", summary="Answer it", status_code=201)
    def answers(asked: NewAnswers) -> dict[Literal["kept"], int]:
        records.answer(records.trainee(asked.trainee), asked.attempt, asked.group, asked.values)
        return {"kept": len(asked.values)}

    return api


def say_errors(app: FastAPI) -> None:
    """Let every error of the interface be a sentence under `detail`."""

    def answer(status: int, sentence: str) -> JSONResponse:
        return JSONResponse({"detail": sentence}, status_code=status)

    @app.exception_handler(InputError)
    def refused(_: Request, error: InputError) -> JSONResponse:
        return answer(422, str(error))

    @app.exception_handler(BusyError)
    def busy(_: Request, error: BusyError) -> JSONResponse:
        return answer(409, str(error))

    @app.exception_handler(TrocarError)
    def failed(_: Request, error: TrocarError) -> JSONResponse:
        return answer(503, str(error))

    @app.exception_handler(RequestValidationError)
    def malformed(_: Request, error: RequestValidationError) -> JSONResponse:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"][1:])) or "the body"
        if first["type"] == "missing":
            return answer(422, f"{where}: it is missing; {_TOLD}")
        return answer(422, f"{where}: {first['msg'].lower()}, got {str(first['input'])[:80]!r}")

    @app.exception_handler(StarletteHTTPException)
    async def elsewhere(request: Request, error: StarletteHTTPException) -> Response:
        path, said = request.url.path, error.detail != HTTPStatus(error.status_code).phrase
        if said or error.status_code not in (404, 405) or not path.startswith("/api/"):
            return await http_exception_handler(request, error)
        if allowed := (error.headers or {}).get("Allow"):
            return answer(405, f"{path[:80]}: expected {allowed}, got {request.method}; {_TOLD}")
        return answer(404, f"{path[:80]}: there is nothing here; {_TOLD}")


def _sheet(screening: Screening, attempt: int | None) -> FilmSheet:
    shown = screening.film
    return FilmSheet(
        attempt=attempt,
        task=screening.task.name,
        level=screening.task.level,
        frames=len(shown),
        every_s=shown.every,
        frame_bytes=len(screening.frames(0, 1)) if len(shown) else 0,
        most_frames=MOST_FRAMES,
        steps_s=tuple(shown.progress.ended),
        mistakes=tuple(
            {"time_s": one.time, "step": one.step + 1, "words": one.words} for one in shown.progress.mistakes
        ),
        parts=tuple(
            FilmPart(**asking(screening.task.steps[stage.steps.start], hidden=True), end_s=stage.end)
            for stage in stages_of(shown.attempt, shown.progress)
        ),
        hello=screening.stage.hello(by_page=False),
    )
