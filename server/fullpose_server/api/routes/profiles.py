"""Profiles: which column of a tool's files is what. Those that ship, and those that people save here."""

from fastapi import APIRouter

from fullpose_server.api.changes import CHANGE
from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Name
from fullpose_server.api.schemas.profiles import ProfileIn, ProfileOut
from fullpose_server.errors import InUseError
from fullpose_server.formats.profile import Profile, shipped

router = APIRouter(prefix="/profiles", tags=["trajectories"])


@router.get("")
def list_profiles(services: ServicesDep) -> list[ProfileOut]:
    """All profiles, those that ship first."""
    saved = services.profiles.all()
    return [_out(each, saved=False) for each in shipped().values()] + [
        _out(each, saved=True) for each in saved.values()
    ]


@router.put("/{name}", dependencies=CHANGE, responses={409: {"description": "A profile that ships has the name"}})
def save_profile(name: Name, body: ProfileIn, services: ServicesDep) -> ProfileOut:
    """Save a column map under a name, by which an upload may ask for it."""
    try:
        return _out(services.profiles.save(name, body.about, body.columns), saved=True)
    except InUseError as error:
        raise ApiError(409, "in-use", str(error)) from None


@router.delete(
    "/{name}",
    status_code=204,
    dependencies=CHANGE,
    responses={404: {"description": "None of that name"}, 409: {"description": "It ships with Fullpose"}},
)
def remove_profile(name: Name, services: ServicesDep) -> None:
    """Remove a saved profile. Flights that were read by it stay."""
    try:
        services.profiles.remove(name)
    except InUseError as error:
        raise ApiError(409, "in-use", str(error)) from None


def _out(profile: Profile, *, saved: bool) -> ProfileOut:
    return ProfileOut(name=profile.name, about=profile.about, axes=profile.axes.value, saved=saved)
