"""JSON Schema of the TOML files, as editors and validators read it."""

from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema


class _Tidy(GenerateJsonSchema):
    """No titles that repeat a key, no null (TOML has none), of a docstring its first paragraph."""

    def field_title_should_be_set(self, schema: object) -> bool:  # noqa: ARG002  pydantic calls it
        return False

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        made = super().default_schema(schema)
        return {key: value for key, value in made.items() if (key, value) != ("default", None)}

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        made = super().model_schema(schema)
        return {**made, "description": made["description"].split("\n\n")[0]}


def schema(model: type[BaseModel]) -> dict[str, Any]:
    """Give the JSON Schema of a model's files."""
    return {"$schema": _Tidy.schema_dialect, **model.model_json_schema(schema_generator=_Tidy)}
