"""The text messages of the live stream, in JSON; what goes as binary frames stands in `trocar.web.wire`.

Keys carry their unit because here values leave the library. The browser client's types are generated from
these classes by `trocar.web.typescript`, so a message is described once.
"""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

PROTOCOL: Final = 1  # raised whenever a client written for the previous one would misread what comes

Vector = tuple[float, float, float]
Sequence = Annotated[int, Field(ge=0, le=2**32 - 1)]


class Message(BaseModel):
    """What every message shares: nothing is converted, nothing unknown or not finite is let through."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", allow_inf_nan=False)


class LayerSize(Message):
    """A layer of the tissue."""

    name: str
    thickness_m: float


class TissueSize(Message):
    """The block: it covers 0 <= x <= size_m[0] and 0 <= y <= size_m[1], its rest surface is z = 0."""

    name: str
    size_m: tuple[float, float]
    layers: tuple[LayerSize, ...] = Field(description="top first")

    @property
    def thickness(self) -> float:
        """Thickness of all layers together [m]."""
        return sum(layer.thickness_m for layer in self.layers)


class OrganShape(Message):
    """An organ that is no block: the grid's nodes lie on its surface, and its other faces stay as they are."""

    rest_m: tuple[float | None, ...] = Field(
        description="heights of the grid's nodes at rest, x fastest; null where nothing is drawn"
    )
    rim: tuple[int, ...] = Field(
        description="nodes that are drawn from their places beside the organ to its outline"
    )
    rim_m: tuple[tuple[float, float], ...] = Field(description="x and y of those")
    corners_m: tuple[Vector, ...] = Field(description="of the other faces")
    normals: tuple[Vector, ...] = Field(description="of the organ at those corners, of length one")
    faces: tuple[tuple[int, int, int], ...] = Field(description="triangles of those corners")


class InstrumentShape(Message):
    """A straight shaft through a port; the tip lies `length_m` from the handle, through the port."""

    name: Literal["left", "right"]
    port_m: Vector = Field(description="the fixed point the shaft turns about")
    length_m: float = Field(description="from handle to tip")
    shaft_radius_m: float
    tip: Literal["probe", "grasper", "needle-holder", "hook", "scissors"]
    handle_m: Vector = Field(description="where the handle is at the start")


class Camera(Message):
    """The endoscope: it enters at a port and looks at a point."""

    port_m: Vector
    target_m: Vector


class Hello(Message):
    """What the server says first: the tissue, its grid and the instruments."""

    type: Literal["hello"] = "hello"
    protocol: Literal[1] = PROTOCOL
    tissue: TissueSize
    grid: tuple[int, int] = Field(description="nodes along x and y, from edge to edge inclusive")
    instruments: tuple[InstrumentShape, ...]
    camera: Camera
    linear_force_n: float = Field(description="up to this force the tissue's answer is trusted as linear")
    rate_hz: float = Field(description="requested ticks of the servo in a second")
    shape: OrganShape | None = Field(default=None, description="of a tissue that is no block")
    under_m: float = Field(
        default=0.0, description="free depth below a film, down to the tray it is clipped over"
    )
    lessons: bool = Field(default=False, description="whether there are tasks to do, under /api/tasks")
    steered_by: Literal["page", "trainer"] = Field(
        default="page",
        description="whose hands move the instruments: the page's, or a device of the trainer's own",
    )


class TaskMark(Message):
    """Something to be drawn on the tissue while a step is on."""

    place_m: tuple[float, float]
    radius_m: float
    hand: Literal["left", "right"]


class Asked(Message):
    """What a step asks for."""

    words: str
    marks: tuple[TaskMark, ...]
    least_n: tuple[float, float] = Field(description="force asked of the left and the right hand, at least")
    most_n: tuple[float, float] = Field(description="at most; 0 where none is asked for")


State = Literal["running", "marking", "finished", "interrupted"]


class Guiding(Asked):
    """What to do now, in the attempt that is under way."""

    type: Literal["guiding"] = "guiding"
    attempt: int = Field(description="number of its record")
    state: State = Field(description="a finished one has its score card under /api/attempts/")
    step: int = Field(
        description="number of the step that is on, from 0; as many as there are when all is done"
    )
    hint: str = Field(description="what would bring it nearer")
    mistakes: int
    mistake: str = Field(description="the last one")
    time_s: float = Field(description="since the attempt began")
    left_s: float = Field(description="of the time allowed")
    reason: str = Field(description="why it is over, or why the newest ticks are not kept yet")


class Notice(Message):
    """A sentence for the user's eyes."""

    type: Literal["notice"] = "notice"
    level: Literal["info", "warning", "stopped"]
    text: str


class Acknowledgement(Message):
    """The client has taken the frame of this sequence number, and with it all before."""

    type: Literal["ack"] = "ack"
    sequence: Sequence


class Reset(Message):
    """The tissue shall go back to rest."""

    type: Literal["reset"] = "reset"


ServerMessage = Annotated[Hello | Guiding | Notice, Field(discriminator="type")]
ClientMessage = Annotated[Acknowledgement | Reset, Field(discriminator="type")]

_CLIENT_MESSAGE: TypeAdapter[Acknowledgement | Reset] = TypeAdapter(ClientMessage)


def read_client_message(text: str) -> Acknowledgement | Reset:
    """Read one text message of a client.

    Args:
        text: JSON.

    Raises:
        ValueError: the text is no message a client may send (pydantic's `ValidationError` is one).
    """
    return _CLIENT_MESSAGE.validate_json(text)
